//! Which files belong together: a comment at the beginning of one that names them, `;;; kirk: files tools.rmpl mission.rmpl`.

use crate::source::Span;

/// A file named in a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Companion {
    /// Its name, relative to the file that names it.
    pub name: String,
    /// Where it is named.
    pub span: Span,
}

/// The files that a text says make up one program, in their order; itself may be one of them. Only comments before the first
/// form count.
pub fn companions(text: &str) -> Vec<Companion> {
    let mut found = Vec::new();
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        let here = at;
        at += line.len();
        let words = line.trim_start_matches('\u{feff}').trim_start();
        if !words.is_empty() && !words.starts_with(';') {
            break;
        }
        let named = words.trim_start_matches(';').trim_start().strip_prefix("kirk:");
        let Some(named) = named.and_then(|rest| rest.trim_start().strip_prefix("files")) else { continue };
        for name in named.split_whitespace() {
            let start = here + (name.as_ptr() as usize - line.as_ptr() as usize);
            found.push(Companion { name: name.to_string(), span: Span::new(0, start, start + name.len()) });
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_comments_before_the_first_form_name_files() {
        let text = "; A mission.\n;;; kirk: files lib/tools.rmpl  ö.rmpl\n\n(a)\n;;; kirk: files late.rmpl\n";
        let found = companions(text);
        let names: Vec<&str> = found.iter().map(|companion| companion.name.as_str()).collect();
        assert_eq!(names, ["lib/tools.rmpl", "ö.rmpl"]);
        for Companion { name, span } in found {
            assert_eq!(&text[span.start as usize..span.end as usize], name);
        }
        assert_eq!(companions("(a) ; kirk: files b.rmpl"), []);
    }
}
