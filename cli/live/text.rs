//! Text in columns: widths are those on the screen, where some letters are twice as wide as others. What a terminal would obey
//! is spelt out.

use ratatui::text::Span;

use crate::foreign::{one_line, visible};

/// The width of a text on the screen.
pub(crate) fn width(text: &str) -> usize {
    Span::raw(text).width()
}

/// A text cut in its middle if it is too wide: names differ in their beginnings and their ends.
pub(crate) fn cut(text: &str, most: usize) -> String {
    let text = &*one_line(text);
    if width(text) <= most {
        return text.to_string();
    }
    if most < 6 {
        return start(text.chars(), most);
    }
    let (head, tail) = ((most - 2).div_ceil(2), (most - 2) / 2);
    let end: String = start(text.chars().rev(), tail).chars().rev().collect();
    start(text.chars(), head) + ".." + &end
}

/// A text cut at its end if it is too wide.
pub(crate) fn shorten(text: &str, most: usize) -> String {
    let text = &*one_line(text);
    if width(text) <= most {
        return text.to_string();
    }
    start(text.chars(), most.saturating_sub(2)) + &".."[..most.min(2)]
}

/// A text in lines of words.
pub(crate) fn wrap(text: &str, most: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in visible(text).split_whitespace() {
        match lines.last_mut() {
            Some(line) if width(line) + 1 + width(word) <= most => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(cut(word, most)),
        }
    }
    lines
}

fn start(chars: impl Iterator<Item = char>, most: usize) -> String {
    let mut taken = String::new();
    let mut wide = 0;
    for char in chars {
        wide += width(char.encode_utf8(&mut [0; 4]));
        if wide > most {
            break;
        }
        taken.push(char);
    }
    taken
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_keep_their_beginnings_and_their_ends() {
        assert_eq!(cut("drill:end", 9), "drill:end");
        assert_eq!(cut("human-downlink-science:end", 15), "human-d..ce:end");
        assert_eq!(cut("human-downlink-science:end", 5), "human");
        assert_eq!(shorten("observed, happened in [15, 17]", 12), "observed, ..");
        assert_eq!(shorten("observed", 1), ".");
    }

    #[test]
    fn wide_letters_take_two_columns() {
        assert_eq!(width("漢字:end"), 8);
        for most in 0..30 {
            assert!(width(&cut("漢字漢字漢字漢字漢字:end", most)) <= most);
        }
    }

    #[test]
    fn lines_are_made_of_words() {
        assert_eq!(wrap("the driver failed: exit status 7", 12), ["the driver", "failed: exit", "status 7"]);
        assert_eq!(wrap("", 12), Vec::<String>::new());
        assert_eq!(wrap("incomprehensibilities here", 8), ["inc..ies", "here"]);
    }
}
