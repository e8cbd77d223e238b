//! Rust source as words and marks, without comments.

/// What a piece of source is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Kind {
    Word(String),
    /// The content of a string literal.
    Text(String),
    /// `::`
    PathSeparator,
    Mark(char),
}

/// A piece of source and its line, counted from 1.
#[derive(Clone, Debug)]
pub struct Token {
    pub kind: Kind,
    pub line: usize,
}

impl Token {
    /// The word, if the token is one.
    pub fn word(&self) -> Option<&str> {
        match &self.kind {
            Kind::Word(word) => Some(word),
            _ => None,
        }
    }

    pub fn is_word(&self, word: &str) -> bool {
        self.word() == Some(word)
    }

    pub fn is_mark(&self, mark: char) -> bool {
        self.kind == Kind::Mark(mark)
    }

    pub fn is_separator(&self) -> bool {
        self.kind == Kind::PathSeparator
    }
}

/// The tokens of a source file.
pub fn tokens(source: &str) -> Vec<Token> {
    let mut reader = Reader {
        chars: source.chars().collect(),
        at: 0,
        line: 1,
    };
    let mut found = Vec::new();
    while let Some(token) = reader.next_token() {
        found.push(token);
    }
    found
}

struct Reader {
    chars: Vec<char>,
    at: usize,
    line: usize,
}

impl Reader {
    fn peek(&self, ahead: usize) -> Option<char> {
        self.chars.get(self.at + ahead).copied()
    }

    fn advance(&mut self) -> Option<char> {
        let c = self.peek(0)?;
        self.at += 1;
        if c == '\n' {
            self.line += 1;
        }
        Some(c)
    }

    fn take_while(&mut self, fits: impl Fn(char) -> bool) -> String {
        let mut text = String::new();
        while let Some(c) = self.peek(0).filter(|c| fits(*c)) {
            text.push(c);
            self.advance();
        }
        text
    }

    fn next_token(&mut self) -> Option<Token> {
        loop {
            let line = self.line;
            let token = |kind| Some(Token { kind, line });
            match (self.peek(0)?, self.peek(1)) {
                (c, _) if c.is_whitespace() => {
                    self.advance();
                }
                ('/', Some('/')) => {
                    self.take_while(|c| c != '\n');
                }
                ('/', Some('*')) => self.skip_block_comment(),
                ('"', _) => return token(Kind::Text(self.quoted())),
                ('\'', _) => self.skip_character_or_lifetime(),
                (':', Some(':')) => {
                    self.at += 2;
                    return token(Kind::PathSeparator);
                }
                (c, _) if c.is_alphanumeric() || c == '_' => {
                    let word = self.take_while(|c| c.is_alphanumeric() || c == '_');
                    match self.literal_behind(&word) {
                        Some(text) => return token(Kind::Text(text)),
                        None => return token(Kind::Word(word)),
                    }
                }
                (c, _) => {
                    self.advance();
                    return token(Kind::Mark(c));
                }
            }
        }
    }

    /// The content of a literal whose prefix was just read: `r"…"`, `br#"…"#`, `b"…"`, `c"…"`.
    fn literal_behind(&mut self, prefix: &str) -> Option<String> {
        let raw = ["r", "br", "cr"].contains(&prefix);
        let plain = ["b", "c"].contains(&prefix);
        let hashes = (0..).take_while(|n| self.peek(*n) == Some('#')).count();
        if plain && self.peek(0) == Some('"') {
            return Some(self.quoted());
        }
        if !raw || self.peek(hashes) != Some('"') {
            return None;
        }
        self.at += hashes + 1;
        let mut text = String::new();
        let ends = |this: &Self| {
            this.peek(0) == Some('"') && (1..=hashes).all(|n| this.peek(n) == Some('#'))
        };
        while !ends(self) {
            text.push(self.advance()?);
        }
        self.at += hashes + 1;
        Some(text)
    }

    fn quoted(&mut self) -> String {
        let mut text = String::new();
        self.advance();
        while let Some(c) = self.advance() {
            match c {
                '"' => break,
                '\\' => text.extend(self.advance()),
                c => text.push(c),
            }
        }
        text
    }

    fn skip_block_comment(&mut self) {
        let mut depth = 0;
        loop {
            match (self.peek(0), self.peek(1)) {
                (Some('/'), Some('*')) => {
                    depth += 1;
                    self.at += 2;
                }
                (Some('*'), Some('/')) => {
                    depth -= 1;
                    self.at += 2;
                }
                (Some(_), _) => {
                    self.advance();
                }
                (None, _) => return,
            }
            if depth == 0 {
                return;
            }
        }
    }

    fn skip_character_or_lifetime(&mut self) {
        self.advance();
        if self.peek(0) == Some('\\') {
            self.at += 2;
            self.take_while(|c| c != '\'');
            self.advance();
        } else if self.peek(1) == Some('\'') {
            self.advance();
            self.advance();
        } else {
            self.take_while(|c| c.is_alphanumeric() || c == '_');
        }
    }
}
