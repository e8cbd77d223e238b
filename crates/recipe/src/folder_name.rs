//! A recipe's name as the name of a folder.

/// Characters that some system does not allow in a name, and the one that stands for them.
const NOT_IN_NAMES: &str = "/\\:*?\"<>|%";

/// A text as the name of a folder. A dot at the beginning would hide the folder; a dot or a space at
/// the end, which some systems drop, would make two names one.
pub(crate) fn folder_name(text: &str) -> String {
    if text.is_empty() {
        return "%".to_owned();
    }
    let last = text.len();
    let mut name = String::new();
    for (at, c) in text.char_indices() {
        let is_at_end = at == 0 || at + c.len_utf8() == last;
        let hides = is_at_end && (c == '.' || c.is_whitespace());
        match hides || c.is_control() || NOT_IN_NAMES.contains(c) {
            true => name.extend(c.to_string().bytes().map(|byte| format!("%{byte:02X}"))),
            false => name.push(c),
        }
    }
    name
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use proptest::prelude::*;

    use super::folder_name;

    #[test]
    fn a_name_that_every_system_allows_stays() {
        for name in ["mirror", "Astigmatic mirror, 5 mm", "a-b_c.d", "Spiegel Ø"] {
            assert_eq!(folder_name(name), name);
        }
    }

    #[test]
    fn other_names_are_folders_of_their_own() {
        let names = [
            "a/b",
            "a\nb",
            "a\tb",
            "a-b",
            "a%2Fb",
            "a\\b",
            "",
            "%",
            ".",
            "..",
            " a",
            "a",
            "a ",
            "a.",
            "\u{1b}[2J",
            "\u{85}",
        ];
        let mut folders = BTreeMap::new();
        for name in names {
            let folder = folder_name(name);
            let is_safe = !folder.is_empty()
                && !folder.starts_with('.')
                && !folder.contains(['/', '\\'])
                && !folder.contains(char::is_control);
            assert!(is_safe, "{name:?}: {folder:?}");
            let other = folders.insert(folder, name);
            assert_eq!(other, None, "{name:?}");
        }
        assert_eq!(folder_name("../../escape"), "%2E.%2F..%2Fescape");
    }

    proptest! {
        #[test]
        fn a_folder_gives_its_name_back(name in any::<String>()) {
            let folder = folder_name(&name);
            let mut bytes = Vec::new();
            let mut rest = folder.bytes();
            while let Some(byte) = rest.next() {
                bytes.push(match byte {
                    b'%' if folder != "%" => {
                        let digits = [rest.next().unwrap(), rest.next().unwrap()];
                        let digits = std::str::from_utf8(&digits).unwrap().to_owned();
                        u8::from_str_radix(&digits, 16).unwrap()
                    }
                    byte => byte,
                });
            }
            let text = String::from_utf8(bytes).unwrap();
            prop_assert!(text == name || (name.is_empty() && folder == "%"));
        }
    }
}
