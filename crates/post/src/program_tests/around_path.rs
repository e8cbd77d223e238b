//! The lines of a program outside of its path are those of its header and of its footer.

use std::path::Path;

use super::travel::with_leads;
use super::*;
use crate::POSTS;

#[test]
fn header_and_footer_of_a_file_are_the_ones_it_was_written_with() {
    for post in POSTS {
        let layout = plain(post);
        for text in [
            program(&layout, &with_leads()),
            assembled(
                &layout,
                &lines_in_sections(&layout, &with_leads(), &[], 2..4),
            ),
        ] {
            let around = layout
                .around_path_in(text.as_bytes(), Path::new("p"))
                .unwrap();
            assert_eq!(around.header, "OPEN PROG 1 CLEAR\n", "{}", post.name);
            assert_eq!(around.footer, "CLOSE\n", "{}", post.name);
            let lines = text.lines().count() as u64;
            assert_eq!(around.before_footer, lines - 1, "{text}");
        }
    }
}

/// A line that somebody has added is found whatever it says, and no comment of a person ends the header.
#[test]
fn added_lines_are_found() {
    for post in POSTS {
        let layout = plain(post);
        let text = program(&layout, &with_leads());
        let comment = post.comment;
        let added = format!("{comment} -- cutting edge --\nG0 Z-5\n{text}G0 Z-6");
        let around = layout
            .around_path_in(added.as_bytes(), Path::new("p"))
            .unwrap();
        assert!(around.header.contains("G0 Z-5\n"), "{}", around.header);
        assert_eq!(around.footer, "CLOSE\nG0 Z-6", "{}", post.name);
    }
}
