//! Foreign text on a terminal. Names, news, what drivers say and what files contain may hold characters that move the cursor,
//! change colours, or turn the direction of writing; here they are shown as what they are.

use std::borrow::Cow;

/// A text of several lines in which nothing but what is seen is said: `\u{202e}` for the character of that number.
pub(crate) fn visible(text: &str) -> Cow<'_, str> {
    spelt_out(text, |character| character != '\n' && is_odd(character))
}

/// The same for a text that belongs into one line.
pub(crate) fn one_line(text: &str) -> Cow<'_, str> {
    spelt_out(text, is_odd)
}

/// A source to show parts of: places in it stay where they are, so what is odd is replaced by something of its length.
pub(crate) fn as_long(text: &str) -> Cow<'_, str> {
    let stays = |character| matches!(character, '\n' | '\r' | '\t') || !is_odd(character);
    if text.chars().all(stays) {
        return Cow::Borrowed(text);
    }
    let replaced = |character: char| match character.len_utf8() {
        _ if stays(character) => character.to_string(),
        3 => char::REPLACEMENT_CHARACTER.to_string(),
        length => "?".repeat(length),
    };
    Cow::Owned(text.chars().map(replaced).collect())
}

fn spelt_out(text: &str, odd: impl Fn(char) -> bool) -> Cow<'_, str> {
    if !text.chars().any(&odd) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 8);
    for character in text.chars() {
        match odd(character) {
            true => shown.extend(character.escape_unicode()),
            false => shown.push(character),
        }
    }
    Cow::Owned(shown)
}

/// True for what a terminal obeys instead of showing it: control characters, marks that turn the direction of writing, other
/// ends of lines, and what has no width at all.
fn is_odd(character: char) -> bool {
    character.is_control()
        || matches!(character,
            '\u{061c}' | '\u{200b}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}'
            | '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e007f}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_terminal_would_obey_is_spelt_out_and_the_rest_is_left_alone() {
        let plain = "drive:end, (2, dock), caf\u{e9}, 火星, -> \u{1f680}";
        assert!(matches!(visible(plain), Cow::Borrowed(_)) && matches!(as_long(plain), Cow::Borrowed(_)));
        assert_eq!(
            visible("\u{1b}[2Ja\u{202e}b\nc\u{9b}m\r"),
            r"\u{1b}[2Ja\u{202e}b
c\u{9b}m\u{d}"
        );
        assert_eq!(one_line("a\nb\t"), r"a\u{a}b\u{9}");
    }

    #[test]
    fn places_in_a_source_stay_where_they_are() {
        let source = "a\u{1b}b\u{9b}c\u{202e}d\u{e0041}\te\r\n";
        let shown = as_long(source);
        assert_eq!(shown, "a?b??c\u{fffd}d????\te\r\n");
        assert_eq!(shown.len(), source.len());
    }
}
