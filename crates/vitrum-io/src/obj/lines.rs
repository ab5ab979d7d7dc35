//! The statements of an OBJ or MTL file: lines joined where a backslash ends one, cut into words.
//!
//! Lines end in LF, CR LF, or, in a file without any LF, in CR. A line number is that of the statement's first line,
//! counted from 1. A `#` at the start of a word begins a comment, except in names, where it is a character like any
//! other: so comments are taken off by [`words`] and not here, and only a line that is nothing but a comment is
//! dropped (and never continued).

use std::borrow::Cow;

/// One statement and the number of its first line.
pub(super) struct Statement<'a> {
    pub(super) line: u64,
    pub(super) text: Cow<'a, [u8]>,
}

/// Every statement of a file that has at least one word.
pub(super) fn statements(bytes: &[u8]) -> impl Iterator<Item = Statement<'_>> {
    const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";
    let bytes = bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes);
    let end = if bytes.contains(&b'\n') { b'\n' } else { b'\r' };
    let mut lines = (1..).zip(bytes.split(move |&byte| byte == end));
    std::iter::from_fn(move || {
        loop {
            let (line, first) = lines.next()?;
            let first = first.trim_ascii();
            if first.is_empty() || first.starts_with(b"#") {
                continue;
            }
            if !first.ends_with(b"\\") {
                return Some(Statement { line, text: Cow::Borrowed(first) });
            }
            let mut joined = first.to_vec();
            while joined.last() == Some(&b'\\') {
                joined.pop();
                joined.push(b' ');
                joined.extend_from_slice(lines.next().map_or(&[][..], |(_, next)| next.trim_ascii()));
            }
            return Some(Statement { line, text: Cow::Owned(joined) });
        }
    })
}

/// The words of a statement up to a comment.
pub(super) fn words(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    text.split(u8::is_ascii_whitespace)
        .filter(|word| !word.is_empty())
        .take_while(|word| !word.starts_with(b"#"))
}

/// The first word of a statement, and the rest without the blanks around it: a name, which may hold blanks and `#`.
pub(super) fn keyword_and_rest(text: &[u8]) -> (&[u8], &[u8]) {
    let text = text.trim_ascii();
    let end = text.iter().position(u8::is_ascii_whitespace).unwrap_or(text.len());
    (&text[..end], text[end..].trim_ascii())
}

/// A name or a word for people to read.
pub(super) fn readable(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// A word, in quotes and cut to a length that fits a message.
pub(super) fn quoted(word: &[u8]) -> String {
    const LONGEST: usize = 40;
    if word.len() <= LONGEST {
        format!("`{}`", readable(word))
    } else {
        format!("`{}...`", readable(&word[..LONGEST]))
    }
}

/// A number as programs write it, the spellings of Microsoft's C library for infinity and not-a-number included
/// (`1.#INF`, `-1.#IND`, `nan(ind)`): those become NaN, because all that matters is that they are not finite.
pub(super) fn number(word: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(word).ok()?;
    if let Ok(number) = text.parse() {
        return Some(number);
    }
    let unsigned = text.trim_start_matches(['+', '-']).to_ascii_lowercase();
    (unsigned.starts_with("1.#") || unsigned.starts_with("nan(")).then_some(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Vec<(u64, String)> {
        statements(text.as_bytes()).map(|s| (s.line, readable(&s.text))).collect()
    }

    #[test]
    fn lines_of_any_ending_keep_their_numbers() {
        let expected = vec![(2, "v 1".to_owned()), (4, "v 2".to_owned())];
        assert_eq!(read("# head\nv 1\n\n  v 2  \n"), expected);
        assert_eq!(read("# head\r\nv 1\r\n\r\nv 2"), expected);
        assert_eq!(read("# head\rv 1\r\rv 2\r"), expected);
        assert_eq!(read("\u{feff}# head\nv 1\n\nv 2"), expected);
    }

    #[test]
    fn a_backslash_joins_lines_but_not_comments() {
        assert_eq!(read("f 1 2 \\\n3 \\ \r\n4\nv 1"), vec![(1, "f 1 2  3  4".into()), (4, "v 1".into())]);
        assert_eq!(read("# c \\\nv 1"), vec![(2, "v 1".into())]);
        assert_eq!(read("f 1 \\"), vec![(1, "f 1  ".into())]);
    }

    #[test]
    fn numbers_in_every_spelling() {
        assert_eq!(number(b"-1.5e3"), Some(-1500.0));
        assert!(number(b"-1.#IND").is_some_and(f64::is_nan));
        assert!(number(b"-nan(ind)").is_some_and(f64::is_nan));
        assert_eq!(number(b"inf"), Some(f64::INFINITY));
        assert_eq!(number(b"1,5"), None);
        assert_eq!(number(b"\xff"), None);
    }
}
