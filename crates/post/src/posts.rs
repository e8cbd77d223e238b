//! The posts, by their names.

use crate::automation1::AUTOMATION1_PVT;
use crate::beckhoff_poly::BECKHOFF_POLY;
use crate::g93::{BECKHOFF_G93, LINUXCNC_G93, NANOTECH_G93};
use crate::pmac::PMAC_PVT;
use crate::post::Post;
use crate::power_pmac::POWER_PMAC_PVT;
use crate::siemens_840d::SIEMENS_840D_POLY;

/// All posts. A new one is a folder of this crate, and a line here.
pub const POSTS: &[Post] = &[
    PMAC_PVT,
    POWER_PMAC_PVT,
    AUTOMATION1_PVT,
    SIEMENS_840D_POLY,
    BECKHOFF_POLY,
    BECKHOFF_G93,
    NANOTECH_G93,
    LINUXCNC_G93,
];

/// The names of all posts, in their order.
pub const POST_NAMES: &[&str] = &{
    let mut names = [""; POSTS.len()];
    let mut k = 0;
    while k < names.len() {
        names[k] = POSTS[k].name;
        k += 1;
    }
    names
};

/// The post of that name.
pub fn post_named(name: &str) -> Option<&'static Post> {
    POSTS.iter().find(|post| post.name == name)
}

/// The post whose files' names end so, in any case.
pub fn post_of_extension(extension: &str) -> Option<&'static Post> {
    let same = |post: &&Post| post.extension.eq_ignore_ascii_case(extension);
    POSTS.iter().find(same)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Template;

    #[test]
    fn a_post_is_found_by_its_name_and_by_its_files() {
        for (k, post) in POSTS.iter().enumerate() {
            assert_eq!(post_named(post.name).unwrap().name, post.name);
            let end = post.extension.to_uppercase();
            assert_eq!(post_of_extension(&end).unwrap().name, post.name);
            assert_eq!(post.table, format!("output.{}", post.name));
            assert_eq!(POST_NAMES[k], post.name);
        }
        assert!(post_named("pmac").is_none() && post_of_extension("csv").is_none());
    }

    #[test]
    fn the_posts_own_templates_are_harmless_and_say_where_the_path_comes_from() {
        for post in POSTS {
            for text in [post.header, post.footer] {
                let commands = post.dialect.commands(text);
                assert!(commands.iter().all(|command| command.harmless), "{text}");
                assert!(Template::parse(text, post.comment).is_ok(), "{text}");
            }
            for word in [
                "{name}", "{recipe}", "{sha256}", "{points}", "{time_s}", "{ends}",
            ] {
                assert!(post.header.contains(word), "{}: {word}", post.name);
            }
            assert!(post.dialect.leaves_program_open(post.header));
        }
    }
}
