//! What one module defines, imports and names.

use std::collections::{BTreeMap, BTreeSet};

use super::tokens::{Kind, Token};

/// A module, in a file of its own or inside another module's.
#[derive(Debug, Default)]
pub struct Module {
    /// The file's index.
    pub file: usize,
    /// The module's index; the root has none.
    pub parent: Option<usize>,
    pub children: BTreeMap<String, usize>,
    /// Items that the module defines.
    pub items: BTreeSet<String>,
    pub uses: Vec<Use>,
    /// Paths of at least two segments in the code.
    pub paths: Vec<(Vec<String>, usize)>,
    /// Words in the code, apart from `use` statements, fields and methods.
    pub words: BTreeSet<String>,
}

/// One name that a `use` brings in.
#[derive(Clone, Debug)]
pub struct Use {
    /// The name in this module; none for a glob.
    pub name: Option<String>,
    pub path: Vec<String>,
    /// Whether other modules see it too.
    pub passed_on: bool,
    pub line: usize,
}

/// A module that another declares.
#[derive(Debug)]
pub struct Declaration {
    pub name: String,
    /// The value of its `#[path]`.
    pub path: Option<String>,
    /// The tokens between its braces; none if it stands in a file of its own.
    pub body: Option<Vec<Token>>,
}

const DEFINING: [&str; 8] = [
    "fn", "struct", "enum", "union", "trait", "type", "const", "static",
];
const KEYWORDS: [&str; 5] = ["fn", "unsafe", "extern", "mut", "async"];

/// Reads the tokens of a module's body into `module`; gives the modules that it declares, and the
/// macros that it exports to the crate's root.
pub fn read(tokens: &[Token], module: &mut Module) -> (Vec<Declaration>, Vec<String>) {
    let (mut declared, mut macros) = (Vec::new(), Vec::new());
    let (mut depth, mut at) = (0, 0);
    let mut attributes: Vec<&[Token]> = Vec::new();
    while at < tokens.len() {
        let rest = &tokens[at..];
        if rest[0].is_mark('#') {
            let inner = usize::from(rest.get(1).is_some_and(|token| token.is_mark('!')));
            if rest.get(1 + inner).is_some_and(|token| token.is_mark('[')) {
                let length = group(&rest[1 + inner..]);
                let content = &rest[2 + inner..inner + length];
                if is_for_tests(content) && inner == 0 {
                    at += item(rest);
                    attributes.clear();
                } else {
                    attributes.push(content);
                    at += 1 + inner + length;
                }
                continue;
            }
        }
        let next = rest.get(1).and_then(Token::word);
        match rest[0].word() {
            Some("mod") if depth == 0 && next.is_some() => {
                let body = rest.get(2).filter(|token| token.is_mark('{'));
                let length = body.map_or(1, |_| group(&rest[2..]));
                declared.push(Declaration {
                    name: next.unwrap_or_default().to_owned(),
                    path: attributes.iter().find_map(|content| path_of(content)),
                    body: body.map(|_| rest[3..1 + length].to_vec()),
                });
                at += 2 + length;
                attributes.clear();
                continue;
            }
            Some("use") => {
                let end = rest.iter().position(|token| token.is_mark(';'));
                let end = end.unwrap_or(rest.len());
                let passed_on = depth == 0 && is_public(&tokens[..at]);
                use_tree(&rest[1..end], &[], passed_on, &mut module.uses);
                at += end + 1;
                attributes.clear();
                continue;
            }
            Some("macro_rules") => {
                if let Some(name) = rest.get(2).and_then(Token::word) {
                    module.items.insert(name.to_owned());
                    let exported = |content: &[Token]| content[0].is_word("macro_export");
                    if attributes.iter().any(|content| exported(content)) {
                        macros.push(name.to_owned());
                    }
                }
            }
            Some(word) if depth == 0 && DEFINING.contains(&word) => {
                let name = next.filter(|name| !KEYWORDS.contains(name));
                module.items.extend(name.map(str::to_owned));
            }
            _ => {}
        }
        match &rest[0].kind {
            Kind::Mark('{' | '(' | '[') => depth += 1,
            Kind::Mark('}' | ')' | ']') => depth -= 1,
            Kind::Word(word) => {
                let before = at.checked_sub(1).map(|before| &tokens[before]);
                if before.is_none_or(|token| !token.is_mark('.') && !token.is_separator()) {
                    let path = path(rest);
                    if path.len() > 1 {
                        module.paths.push((path, rest[0].line));
                    }
                    let defined = before.and_then(Token::word);
                    if !defined.is_some_and(|word| DEFINING.contains(&word)) {
                        module.words.insert(word.clone());
                    }
                }
            }
            _ => {}
        }
        if !rest[0].is_word("pub") {
            attributes.clear();
        }
        at += 1;
    }
    (declared, macros)
}

/// How many tokens the group takes that begins with a bracket.
fn group(tokens: &[Token]) -> usize {
    let mut depth = 0;
    for (index, token) in tokens.iter().enumerate() {
        match token.kind {
            Kind::Mark('{' | '(' | '[') => depth += 1,
            Kind::Mark('}' | ')' | ']') => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return index + 1;
        }
    }
    tokens.len()
}

/// How many tokens the item takes that begins with attributes: up to `;` or the end of its braces.
fn item(tokens: &[Token]) -> usize {
    let mut at = 0;
    let is_use = |token: &Token| token.is_word("use");
    let mut in_use = false;
    while at < tokens.len() {
        let token = &tokens[at];
        in_use |= is_use(token);
        match token.kind {
            Kind::Mark(';') => return at + 1,
            Kind::Mark('{') if !in_use => return at + group(&tokens[at..]),
            Kind::Mark('{' | '(' | '[') => at += group(&tokens[at..]),
            _ => at += 1,
        }
    }
    tokens.len()
}

fn is_for_tests(attribute: &[Token]) -> bool {
    matches!(attribute, [cfg, open, test, _]
        if cfg.is_word("cfg") && open.is_mark('(') && test.is_word("test"))
}

/// The text of `path = "…"`.
fn path_of(attribute: &[Token]) -> Option<String> {
    match attribute {
        [name, _, text] if name.is_word("path") => match &text.kind {
            Kind::Text(text) => Some(text.clone()),
            _ => None,
        },
        _ => None,
    }
}

/// Whether these tokens end with `pub` or `pub(…)`.
fn is_public(before: &[Token]) -> bool {
    let Some(last) = before.last() else {
        return false;
    };
    if !last.is_mark(')') {
        return last.is_word("pub");
    }
    let open = before.iter().rposition(|token| token.is_mark('('));
    open.is_some_and(|open| open > 0 && before[open - 1].is_word("pub"))
}

/// The words at the beginning that `::` joins.
fn path(tokens: &[Token]) -> Vec<String> {
    let mut path = Vec::new();
    let mut at = 0;
    while let Some(word) = tokens.get(at).and_then(Token::word) {
        path.push(word.to_owned());
        if !tokens.get(at + 1).is_some_and(Token::is_separator) {
            break;
        }
        at += 2;
    }
    path
}

/// Reads the tree of a `use`: `a::{b, c as d, e::*}`.
fn use_tree(tokens: &[Token], before: &[String], passed_on: bool, uses: &mut Vec<Use>) {
    let own = path(tokens);
    let Some(line) = tokens.first().map(|token| token.line) else {
        return;
    };
    let mut whole = [before, &own].concat();
    let behind = &tokens[(2 * own.len()).min(tokens.len())..];
    match behind.first().map(|token| &token.kind) {
        Some(Kind::Mark('{')) => {
            for branch in branches(&behind[1..group(behind) - 1]) {
                use_tree(branch, &whole, passed_on, uses);
            }
        }
        Some(Kind::Mark('*')) => uses.push(Use {
            name: None,
            path: whole,
            passed_on,
            line,
        }),
        _ => {
            // `a as b`: the path ends with `a`, and `as` stands where a separator would.
            let renamed = tokens.iter().position(|token| token.is_word("as"));
            let renamed = renamed
                .and_then(|at| tokens.get(at + 1))
                .and_then(Token::word);
            if whole.last().is_some_and(|last| last == "self") && whole.len() > 1 {
                whole.pop();
            }
            let name = renamed.or(whole.last().map(String::as_str));
            uses.push(Use {
                name: name.map(str::to_owned),
                path: whole.clone(),
                passed_on,
                line,
            });
        }
    }
}

/// The parts between commas, those inside brackets left together.
fn branches(tokens: &[Token]) -> Vec<&[Token]> {
    let (mut found, mut start, mut depth) = (Vec::new(), 0, 0);
    for (index, token) in tokens.iter().enumerate() {
        match token.kind {
            Kind::Mark('{') => depth += 1,
            Kind::Mark('}') => depth -= 1,
            Kind::Mark(',') if depth == 0 => {
                found.push(&tokens[start..index]);
                start = index + 1;
            }
            _ => {}
        }
    }
    found.push(&tokens[start..]);
    found
}
