//! Byte offsets and the positions of the protocol: lines, and columns in the units that were agreed on.

use lsp_types::{Position, PositionEncodingKind};

/// In which units columns are counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Encoding {
    /// Bytes.
    Utf8,
    /// 16-bit code units, the default of the protocol.
    #[default]
    Utf16,
}

impl Encoding {
    /// The first of the offered encodings that suits; bytes save work.
    pub fn negotiate(offered: Option<&[PositionEncodingKind]>) -> Encoding {
        match offered {
            Some(offered) if offered.contains(&PositionEncodingKind::UTF8) => Encoding::Utf8,
            _ => Encoding::Utf16,
        }
    }

    /// Its name in the protocol.
    pub fn kind(self) -> PositionEncodingKind {
        match self {
            Encoding::Utf8 => PositionEncodingKind::UTF8,
            Encoding::Utf16 => PositionEncodingKind::UTF16,
        }
    }

    /// The length of a text in these units.
    pub fn length(self, text: &str) -> u32 {
        match self {
            Encoding::Utf8 => text.len() as u32,
            Encoding::Utf16 => text.chars().map(|c| c.len_utf16() as u32).sum(),
        }
    }
}

/// Where the lines of a text begin. A line ends with `\n`, `\r\n` or `\r`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Lines {
    starts: Vec<u32>,
    /// How many 16-bit code units come before each block of bytes: a line may be as long as the whole text, and its columns
    /// must not be counted from its beginning each time.
    units: Vec<u32>,
}

/// The number of bytes in a block.
const BLOCK: usize = 512;

/// How many 16-bit code units begin with a byte of UTF-8: two for a character of four bytes, none inside of a character.
fn units(byte: u8) -> u32 {
    match byte {
        0x80..=0xBF => 0,
        0xF0.. => 2,
        _ => 1,
    }
}

impl Lines {
    /// Finds the lines of a text.
    pub fn new(text: &str) -> Lines {
        let bytes = text.as_bytes();
        let ends = |(at, byte): (usize, &u8)| match byte {
            b'\n' => Some(at as u32 + 1),
            b'\r' if bytes.get(at + 1) != Some(&b'\n') => Some(at as u32 + 1),
            _ => None,
        };
        let mut before = 0;
        let block = |block: &[u8]| {
            let here = before;
            before += block.iter().map(|byte| units(*byte)).sum::<u32>();
            here
        };
        Lines {
            starts: std::iter::once(0).chain(bytes.iter().enumerate().filter_map(ends)).collect(),
            units: bytes.chunks(BLOCK).map(block).collect(),
        }
    }

    /// The position of a byte offset, which is on the boundary of a character.
    pub fn position(&self, text: &str, offset: u32, encoding: Encoding) -> Position {
        let line = self.line_of(offset);
        let (start, end) = (self.starts[line] as usize, (offset as usize).min(text.len()));
        let character = match encoding {
            Encoding::Utf8 => (end - start) as u32,
            Encoding::Utf16 => self.units_before(text, end) - self.units_before(text, start),
        };
        Position { line: line as u32, character }
    }

    /// How many 16-bit code units come before a byte of the text.
    fn units_before(&self, text: &str, offset: usize) -> u32 {
        let block = (offset / BLOCK).min(self.units.len().saturating_sub(1));
        let rest = &text.as_bytes()[block * BLOCK..offset];
        self.units.get(block).copied().unwrap_or(0) + rest.iter().map(|byte| units(*byte)).sum::<u32>()
    }

    /// The byte offset of a position: the end of the line if it lies beyond, the end of the text if there is no such line,
    /// the start of the character if it lies inside one.
    pub fn offset(&self, text: &str, position: Position, encoding: Encoding) -> usize {
        let Some(line) = self.line(text, position.line) else { return text.len() };
        let mut units = 0;
        for (at, c) in line.char_indices() {
            units += match encoding {
                Encoding::Utf8 => c.len_utf8() as u32,
                Encoding::Utf16 => c.len_utf16() as u32,
            };
            if units > position.character {
                return self.starts[position.line as usize] as usize + at;
            }
        }
        self.starts[position.line as usize] as usize + line.len()
    }

    /// The number of the line in which a byte is, counted from 0.
    pub fn line_of(&self, offset: u32) -> usize {
        self.starts.partition_point(|start| *start <= offset).max(1) - 1
    }

    /// How many lines there are.
    pub fn count(&self) -> usize {
        self.starts.len()
    }

    /// A line without its end.
    pub fn line<'a>(&self, text: &'a str, line: u32) -> Option<&'a str> {
        let start = *self.starts.get(line as usize)? as usize;
        let end = self.starts.get(line as usize + 1).map_or(text.len(), |next| *next as usize);
        Some(text.get(start..end)?.trim_end_matches(['\n', '\r']))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offsets_and_positions_agree_in_both_encodings() {
        let text = "ab\r\nö𝄞x\rlast\n\n𝄞";
        let lines = Lines::new(text);
        assert_eq!(lines.count(), 5);
        for encoding in [Encoding::Utf8, Encoding::Utf16] {
            for (offset, _) in text.char_indices().chain([(text.len(), ' ')]) {
                let inside_a_line_end = text[..offset].ends_with('\r') && text[offset..].starts_with('\n');
                let position = lines.position(text, offset as u32, encoding);
                let back = lines.offset(text, position, encoding);
                assert_eq!(
                    back,
                    if inside_a_line_end { offset - 1 } else { offset },
                    "{offset} {position:?}"
                );
            }
        }
        let at = |line, character| Position { line, character };
        assert_eq!(lines.position(text, 10, Encoding::Utf16), at(1, 3));
        assert_eq!(lines.position(text, 10, Encoding::Utf8), at(1, 6));
        assert_eq!(lines.offset(text, at(0, 99), Encoding::Utf16), 2);
        assert_eq!(lines.offset(text, at(99, 0), Encoding::Utf16), text.len());
        assert_eq!(lines.offset(text, at(1, 2), Encoding::Utf16), 6, "inside a pair is before it");
    }

    #[test]
    fn the_columns_of_a_long_line_are_those_counted_from_its_beginning() {
        let text = format!("x\n{}\r\n{}", "ab ö€𝄞".repeat(200), "𝄞y".repeat(300));
        let lines = Lines::new(&text);
        for (offset, _) in text.char_indices().chain([(text.len(), ' ')]) {
            let start = text[..offset].rfind('\n').map_or(0, |end| end + 1);
            for encoding in [Encoding::Utf8, Encoding::Utf16] {
                let position = lines.position(&text, offset as u32, encoding);
                assert_eq!(position.character, encoding.length(&text[start..offset]), "{offset}");
            }
        }
    }

    #[test]
    fn bytes_are_chosen_only_if_offered() {
        let offered = [PositionEncodingKind::UTF32, PositionEncodingKind::UTF8];
        assert_eq!(Encoding::negotiate(None), Encoding::Utf16);
        assert_eq!(Encoding::negotiate(Some(&offered[..1])), Encoding::Utf16);
        assert_eq!(Encoding::negotiate(Some(&offered)), Encoding::Utf8);
    }
}
