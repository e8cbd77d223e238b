//! HTML from texts that may hold anything.

/// A text as HTML shows it.
pub fn escaped(text: &str) -> String {
    let mut html = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => html += "&amp;",
            '<' => html += "&lt;",
            '>' => html += "&gt;",
            '"' => html += "&quot;",
            '\'' => html += "&#39;",
            '\n' | '\t' => html.push(c),
            c if c.is_control() => html += &escaped(&c.escape_unicode().to_string()),
            c => html.push(c),
        }
    }
    html
}

/// An element with a class around HTML.
pub fn element(tag: &str, class: &str, html: &str) -> String {
    match class {
        "" => format!("<{tag}>{html}</{tag}>"),
        class => format!("<{tag} class=\"{class}\">{html}</{tag}>"),
    }
}

/// A row of a table: texts.
pub fn row(tag: &str, cells: &[&str]) -> String {
    let cells = cells.iter().map(|cell| element(tag, "", &escaped(cell)));
    element("tr", "", &cells.collect::<String>())
}

/// A section with a heading and an anchor.
pub fn section(id: &str, title: &str, html: &str) -> String {
    let title = escaped(title);
    format!("<section id=\"{id}\"><h2>{title}</h2>\n{html}</section>\n")
}

/// A place for a figure, which the script draws.
pub fn figure(id: &str, class: &str, title: &str, caption: &str) -> String {
    let (title, caption) = (escaped(title), escaped(caption));
    format!(
        "<figure class=\"{class}\"><h3>{title}</h3><div class=\"plot\" id=\"{id}\" role=\"img\" \
         aria-label=\"{title}\"></div><figcaption>{caption}</figcaption></figure>\n"
    )
}

/// A text with its DOIs as links.
pub fn with_links(text: &str) -> String {
    let word = |word: &str| {
        let begin = word.find("10.").filter(|_| word.contains('/'));
        let Some((before, doi)) = begin.and_then(|begin| word.split_at_checked(begin)) else {
            return escaped(word);
        };
        let end = doi.trim_end_matches(['.', ',', ';', ')']).len();
        let (doi, after) = doi.split_at(end);
        let known = doi
            .chars()
            .all(|c| c.is_ascii_alphanumeric() || "./()-_".contains(c));
        let number = doi.chars().skip(3).take(4).all(|c| c.is_ascii_digit());
        if !known || !number {
            return escaped(word);
        }
        let before = before.trim_end_matches("https://doi.org/");
        let link = format!("<a href=\"https://doi.org/{doi}\" rel=\"noreferrer\">{doi}</a>");
        escaped(before) + &link + &escaped(after)
    };
    let words: Vec<String> = text.split(' ').map(word).collect();
    words.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_text_ends_its_element_or_attribute() {
        assert_eq!(
            escaped("</script><b a='1' b=\"2\">&\u{1b}"),
            "&lt;/script&gt;&lt;b a=&#39;1&#39; b=&quot;2&quot;&gt;&amp;\\u{1b}"
        );
    }

    #[test]
    fn a_doi_is_a_link_and_nothing_else_is() {
        assert_eq!(
            with_links("eq. 3 of doi:10.1364/OE.21.012, p. 10.5 <b>"),
            "eq. 3 of doi:<a href=\"https://doi.org/10.1364/OE.21.012\" \
             rel=\"noreferrer\">10.1364/OE.21.012</a>, p. 10.5 &lt;b&gt;"
        );
        let harmful = "10.1364/x\"onclick=\"1";
        assert_eq!(with_links(harmful), escaped(harmful));
    }
}
