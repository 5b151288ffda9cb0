//! JSON text into whatever serde can read, or what is wrong with it in plain words, and where.

use serde::de::Deserialize;
use serde_json::error::Category;
use serde_json::value::RawValue;

use super::ReadProblem;
use super::element::{Element, Wrong, words};

/// Reads JSON text. What serde_json refuses is read once more as an `Element`, which knows more of what is wrong; a
/// text that is no JSON is looked at where serde_json stopped.
pub fn parse<'a, T: Deserialize<'a>>(text: &'a str) -> Result<T, ReadProblem> {
    serde_json::from_str(text).map_err(|error| match serde_json::from_str::<&RawValue>(text) {
        Err(error) => syntax(text, &error),
        Ok(raw) => match T::deserialize(Element { text, raw }) {
            Err(Wrong::Located(problem)) => problem,
            Ok(_) | Err(_) => ReadProblem { offset: place(text, &error), message: words(&error) },
        },
    })
}

fn syntax(text: &str, error: &serde_json::Error) -> ReadProblem {
    if text.trim().is_empty() {
        let message = "there is nothing here; a JSON document was expected".to_string();
        return ReadProblem { offset: 0, message };
    }
    let offset = place(text, error);
    let (before, rest) = text.split_at(offset);
    let begins = |text: &str, with: &str| text.trim_start().starts_with(|c| with.contains(c));
    let message = match (open(before), before.trim_end().chars().last()) {
        _ if error.classify() == Category::Eof => {
            let what = match open(text) {
                Some('"') => "a string",
                Some('{') => "an object",
                Some('[') => "a list",
                _ => "a value",
            };
            format!("the text ends in the middle of {what}")
        }
        (Some('"'), _) => words(error),
        (None, Some(_)) if begins(before, "{[\"") => {
            "something follows after the end of the JSON document".to_string()
        }
        (Some(_), Some(',')) if begins(rest, "]}") => {
            "a comma stands before the end of this list or object".to_string()
        }
        (Some('{'), Some('{' | ',')) if !begins(rest, "\"") => {
            "the name of a field in double quotation marks was expected here".to_string()
        }
        (_, None | Some('[' | ',' | ':')) if !begins(rest, "{[\"-0123456789tfn") => {
            "a value was expected here: a number, a text in double quotation marks, a list or an object"
                .to_string()
        }
        _ => words(error),
    };
    ReadProblem { offset, message }
}

/// The innermost list, object or text that is open at the end.
fn open(text: &str) -> Option<char> {
    let (mut open, mut escaped) = (Vec::new(), false);
    for c in text.chars() {
        match (open.last(), c) {
            (Some('"'), _) if escaped => escaped = false,
            (Some('"'), '\\') => escaped = true,
            (Some('"'), '"') | (Some('[' | '{'), ']' | '}') => _ = open.pop(),
            (Some('"'), _) => {}
            (_, '"' | '[' | '{') => open.push(c),
            _ => {}
        }
    }
    open.pop()
}

/// Where serde_json stopped.
fn place(text: &str, error: &serde_json::Error) -> usize {
    let before = text.split_inclusive('\n').take(error.line().saturating_sub(1)).map(str::len).sum::<usize>();
    let mut offset = (before + error.column().saturating_sub(1)).min(text.len());
    while !text.is_char_boundary(offset) {
        offset -= 1;
    }
    offset
}

#[cfg(test)]
mod tests {
    use insta::assert_snapshot;
    use serde::Deserialize;
    use serde_json::Value;

    use super::*;
    use crate::time::Duration;

    #[derive(Debug, Deserialize, PartialEq)]
    #[serde(rename_all = "lowercase")]
    enum Colour {
        Red,
        Green,
    }

    #[derive(Debug, Deserialize, PartialEq)]
    #[serde(deny_unknown_fields)]
    struct Thing {
        name: String,
        count: Option<u64>,
        #[serde(default)]
        within: Option<(Duration, Duration)>,
        #[serde(default)]
        colours: Vec<Colour>,
    }

    fn told<'a, T: Deserialize<'a> + std::fmt::Debug>(text: &'a str) -> String {
        let ReadProblem { offset, message } = parse::<T>(text).unwrap_err();
        format!("{text}\n{}^ {message}\n", " ".repeat(text[..offset].chars().count()))
    }

    #[test]
    fn what_is_no_json_is_told_by_where_it_ends() {
        let all = [
            r#"[1, 2"#,
            r#"{"a": ["#,
            r#"{"a""#,
            r#"{"a": 1"#,
            r#""abc"#,
            r#"[1, 2,]"#,
            r#"{"a": 1,}"#,
            r#"{a: 1}"#,
            r#"{'a': 1}"#,
            r#"{,}"#,
            r#"[,]"#,
            r#"[1] 2"#,
            r#"{"a": }"#,
            r#"{"a" 1}"#,
            r#"[1 2]"#,
            r#"[nil]"#,
            r#"[01]"#,
            r#"[-]"#,
            r#""\q""#,
            r#"]"#,
            r#"{"]\"": ]}"#,
            r#"[",]\q"]"#,
            r#"<svg/>"#,
        ];
        assert_snapshot!(all.map(told::<Value>).concat(), @r##"
        [1, 2
            ^ the text ends in the middle of a list
        {"a": [
              ^ the text ends in the middle of a list
        {"a"
           ^ the text ends in the middle of an object
        {"a": 1
              ^ the text ends in the middle of an object
        "abc
           ^ the text ends in the middle of a string
        [1, 2,]
              ^ a comma stands before the end of this list or object
        {"a": 1,}
                ^ a comma stands before the end of this list or object
        {a: 1}
         ^ the name of a field in double quotation marks was expected here
        {'a': 1}
         ^ the name of a field in double quotation marks was expected here
        {,}
         ^ the name of a field in double quotation marks was expected here
        [,]
         ^ a value was expected here: a number, a text in double quotation marks, a list or an object
        [1] 2
            ^ something follows after the end of the JSON document
        {"a": }
              ^ a value was expected here: a number, a text in double quotation marks, a list or an object
        {"a" 1}
             ^ expected `:`
        [1 2]
           ^ expected `,` or `]`
        [nil]
          ^ expected ident
        [01]
          ^ invalid number
        [-]
          ^ invalid number
        "\q"
          ^ invalid escape
        ]
        ^ a value was expected here: a number, a text in double quotation marks, a list or an object
        {"]\"": ]}
                ^ a value was expected here: a number, a text in double quotation marks, a list or an object
        [",]\q"]
             ^ invalid escape
        <svg/>
        ^ a value was expected here: a number, a text in double quotation marks, a list or an object
        "##);
    }

    #[test]
    fn what_is_of_another_shape_is_told_by_what_was_expected() {
        let all = [
            "[]",
            r#"{"nam": "x"}"#,
            r#"{"count": 1}"#,
            r#"{"name": 5}"#,
            r#"{"name": "x", "name": "y", "count": null}"#,
            r#"{"name": "x", "count": -1}"#,
            r#"{"name": "x", "count": 1.5}"#,
            r#"{"name": "x", "count": "many"}"#,
            r#"{"name": "x", "count": [1]}"#,
            r#"{"name": "x", "count": 18446744073709551616}"#,
            r#"{"name": "x", "within": [1, "soon"]}"#,
            r#"{"name": "x", "within": [1, 1e-9]}"#,
            r#"{"name": "x", "within": [1]}"#,
            r#"{"name": "x", "within": [1, 2, 3]}"#,
            r#"{"name": "x", "colours": "red"}"#,
            r#"{"name": "x", "colours": ["red", "blue"]}"#,
            r#"{"name": "x", "colours": ["red", {}]}"#,
            r#"{"name": "\ud800"}"#,
        ];
        assert_snapshot!(all.map(told::<Thing>).concat(), @r##"
        []
        ^ expected an object, not a list
        {"nam": "x"}
                ^ there is no field `nam`; expected one of `name`, `count`, `within`, `colours`
        {"count": 1}
        ^ the field `name` is missing
        {"name": 5}
                 ^ expected a text in quotation marks, not `5`
        {"name": "x", "name": "y", "count": null}
                              ^ the field `name` is there twice
        {"name": "x", "count": -1}
                               ^ expected a whole number that is not negative, not `-1`
        {"name": "x", "count": 1.5}
                               ^ expected a whole number that is not negative, not `1.5`
        {"name": "x", "count": "many"}
                               ^ expected a whole number that is not negative, not the text "many"
        {"name": "x", "count": [1]}
                               ^ expected a whole number that is not negative, not a list
        {"name": "x", "count": 18446744073709551616}
                               ^ expected a whole number below 2^64, not `18446744073709551616`
        {"name": "x", "within": [1, "soon"]}
                                    ^ `"soon"`: this is not a number of seconds
        {"name": "x", "within": [1, 1e-9]}
                                    ^ `1e-9`: this has digits below a microsecond (kirk never rounds a bound)
        {"name": "x", "within": [1]}
                                ^ expected a list of 2, not of 1
        {"name": "x", "within": [1, 2, 3]}
                                ^ expected a list of 2, not of 3
        {"name": "x", "colours": "red"}
                                 ^ expected a list, not the text "red"
        {"name": "x", "colours": ["red", "blue"]}
                                         ^ `blue` is not known here; expected `red` or `green`
        {"name": "x", "colours": ["red", {}]}
                                         ^ expected a text in quotation marks, not an object
        {"name": "\ud800"}
                 ^ unexpected end of hex escape
        "##);
    }

    #[test]
    fn what_nobody_asked_for_may_be_deep() {
        #[derive(Debug, Deserialize)]
        struct Named {
            #[allow(dead_code, reason = "it is only read")]
            name: String,
        }
        let deep = format!("{}{}", "[".repeat(100_000), "]".repeat(100_000));
        let problem = parse::<Named>(&format!(r#"{{"more": {deep}, "name": 5}}"#)).unwrap_err();
        assert_eq!(problem.message, "expected a text in quotation marks, not `5`");
    }

    /// Broken at random, a text means the same to both readers, or nothing to both.
    #[test]
    fn both_readers_agree() {
        const GOOD: &str =
            r#"{"name": "ü\n\u00e9", "count": 12, "within": [-1.5, 2e3], "colours": ["red", "green"]}"#;
        let pieces =
            ["", "\"", "[", "]", "{", "}", ",", ":", "null", "true", "-1", "0.5", "1e9", "\\", "x", "é"];
        let mut read = 0;
        for seed in 0..20_000 {
            let mut random = fastrand::Rng::with_seed(seed);
            let mut text = GOOD.to_string();
            for _ in 0..random.usize(..4) {
                let places: Vec<usize> = text.char_indices().map(|(at, _)| at).chain([text.len()]).collect();
                let first = random.usize(..places.len());
                let last = (first + random.usize(..12)).min(places.len() - 1);
                text.replace_range(places[first]..places[last], pieces[random.usize(..pieces.len())]);
            }
            let expected: Result<Value, _> = serde_json::from_str(&text);
            let found = parse::<Value>(&text);
            assert_eq!(found.as_ref().ok(), expected.as_ref().ok(), "seed {seed}: {text}");
            let Ok(raw) = serde_json::from_str::<&RawValue>(&text) else { continue };
            let element = Element { text: &text, raw };
            assert_eq!(Value::deserialize(element).ok(), expected.ok(), "seed {seed}: {text}");
            let thing: Option<Thing> = serde_json::from_str(&text).ok();
            assert_eq!(Thing::deserialize(element).ok(), thing, "seed {seed}: {text}");
            read += 1;
        }
        assert!(read > 1_000, "only {read} of the texts were JSON");
    }
}
