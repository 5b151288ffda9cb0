//! What a terminal sends, as keys. Bytes may come in any pieces; what is pasted is no key, and what is not known is nothing.

/// A key that means something here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Key {
    Char(char),
    Up,
    Down,
    PageUp,
    PageDown,
    Home,
    End,
    Tab,
    Escape,
    /// Ctrl-C, which is no signal while the screen is up.
    Interrupt,
    /// Ctrl-L.
    Redraw,
}

/// Reads the bytes of a terminal.
#[derive(Debug, Default)]
pub(crate) struct Decoder {
    /// The beginning of a sequence whose end has not come.
    begun: Vec<u8>,
    pasting: bool,
}

/// No sequence of a key is as long as this.
const LONGEST: usize = 32;

impl Decoder {
    /// The keys that are complete with these bytes.
    pub(crate) fn keys(&mut self, bytes: &[u8]) -> Vec<Key> {
        bytes.iter().filter_map(|&byte| self.byte(byte)).collect()
    }

    /// Nothing more has come for a while: what looked like the beginning of a sequence was the Escape key.
    pub(crate) fn pause(&mut self) -> Option<Key> {
        let alone = std::mem::take(&mut self.begun) == [ESCAPE];
        (alone && !self.pasting).then_some(Key::Escape)
    }

    fn byte(&mut self, byte: u8) -> Option<Key> {
        if self.begun.is_empty() && byte != ESCAPE {
            return plain(byte).filter(|_| !self.pasting);
        }
        if byte == ESCAPE {
            self.begun.clear();
        } else if self.begun.len() == LONGEST {
            // No sequence of ours, but its end has to be found.
            self.begun.pop();
        }
        self.begun.push(byte);
        match self.begun.as_slice() {
            [_] | [_, b'[' | b'O'] => None,
            [_, b'[', .., b'@'..=b'~'] | [_, b'O', _] => {
                let sequence = std::mem::take(&mut self.begun);
                self.sequence(&sequence[1..])
            }
            [_, b'[', ..] => None,
            // A key with Alt.
            _ => {
                self.begun.clear();
                None
            }
        }
    }

    fn sequence(&mut self, sequence: &[u8]) -> Option<Key> {
        let key = match sequence {
            b"[200~" => {
                self.pasting = true;
                None
            }
            b"[201~" => {
                self.pasting = false;
                None
            }
            b"[A" | b"OA" => Some(Key::Up),
            b"[B" | b"OB" => Some(Key::Down),
            b"[5~" => Some(Key::PageUp),
            b"[6~" => Some(Key::PageDown),
            b"[H" | b"OH" | b"[1~" | b"[7~" => Some(Key::Home),
            b"[F" | b"OF" | b"[4~" | b"[8~" => Some(Key::End),
            _ => None,
        };
        key.filter(|_| !self.pasting)
    }
}

const ESCAPE: u8 = 0x1b;

fn plain(byte: u8) -> Option<Key> {
    match byte {
        b'\t' => Some(Key::Tab),
        0x03 => Some(Key::Interrupt),
        0x0c => Some(Key::Redraw),
        b' '..=b'~' => Some(Key::Char(char::from(byte))),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sequences_are_keys_however_they_are_cut() {
        let bytes = b"1\t\x1b[A\x1bOB\x1b[5~\x1b[1;5Cz\x1b[H?\x03";
        let keys = [
            Key::Char('1'),
            Key::Tab,
            Key::Up,
            Key::Down,
            Key::PageUp,
            Key::Char('z'),
            Key::Home,
            Key::Char('?'),
            Key::Interrupt,
        ];
        for cut in 0..bytes.len() {
            let mut decoder = Decoder::default();
            let mut found = decoder.keys(&bytes[..cut]);
            found.extend(decoder.keys(&bytes[cut..]));
            assert_eq!(found, keys, "cut at {cut}");
        }
    }

    #[test]
    fn what_is_pasted_is_no_key() {
        let mut decoder = Decoder::default();
        assert_eq!(decoder.keys(b"\x1b[200~12\x03\x1b[A3\x1b[201~4"), [Key::Char('4')]);
    }

    #[test]
    fn escape_is_a_key_when_nothing_follows() {
        let mut decoder = Decoder::default();
        assert_eq!(decoder.keys(b"\x1b"), []);
        assert_eq!(decoder.pause(), Some(Key::Escape));
        assert_eq!(decoder.pause(), None);
        assert_eq!(decoder.keys(b"A"), [Key::Char('A')]);
    }

    #[test]
    fn letters_of_other_alphabets_and_endless_sequences_are_nothing() {
        let mut decoder = Decoder::default();
        assert_eq!(decoder.keys("é漢".as_bytes()), []);
        let mut endless = b"\x1b[".to_vec();
        endless.extend([b'1'; 10_000]);
        assert_eq!(decoder.keys(&endless), []);
        assert!(decoder.begun.len() <= LONGEST);
        assert_eq!(decoder.keys(b"~2"), [Key::Char('2')]);
    }
}
