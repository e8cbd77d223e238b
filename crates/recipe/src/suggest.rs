//! Suggestions for misspelt words, and lists of known words.

/// The known word that is closest to a misspelt one, if any is close. Known words are in ASCII.
pub(crate) fn closest<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    let tidy = |text: &str| text.to_lowercase().replace(['_', ' '], "-");
    let word = tidy(word);
    let length = word.chars().count();
    let allowed = (length / 3).max(1);
    known
        .iter()
        // Words of such different lengths are as far apart.
        .filter(|name| name.chars().count().abs_diff(length) <= allowed)
        .map(|name| (strsim::osa_distance(&word, &tidy(name)), *name))
        .filter(|(distance, _)| *distance <= allowed)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, name)| name)
}

/// Whether a key looks like a misspelling of the right one.
pub(crate) fn is_misspelt(written: &str, right: &str) -> bool {
    closest(written, &[right]).is_some()
}

/// "did you mean `this`?", if a known word is close.
pub(crate) fn did_you_mean(word: &str, known: &[&str]) -> Option<String> {
    closest(word, known).map(|name| format!("did you mean `{name}`?"))
}

/// "`a`, `b`, `c`".
pub(crate) fn listed(words: &[&str]) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("`{word}`")).collect();
    quoted.join(", ")
}

/// A text of the recipe in backticks, shortened if it is long.
pub(crate) fn quoted(text: &str) -> String {
    const LONGEST: usize = 60;
    if text.chars().count() <= LONGEST {
        return format!("`{text}`");
    }
    let start: String = text.chars().take(LONGEST).collect();
    format!("`{start}…`")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn close_names_are_found_and_far_ones_are_not() {
        let known = ["atpg", "fft-adaptive", "equal-arc"];
        assert_eq!(closest("fft-adaptve", &known), Some("fft-adaptive"));
        assert_eq!(closest("FFT_Adaptive", &known), Some("fft-adaptive"));
        assert_eq!(closest("atgp", &known), Some("atpg"));
        assert_eq!(closest("spiral", &known), None);
        assert_eq!(closest("", &known), None);
    }
}
