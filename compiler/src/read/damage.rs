//! What is damaged in a text: parentheses that do not pair, words outside of all forms, characters without a meaning.

use super::foreign::{begins_definition, foreign_line, is_prompt};
use super::problem::{Commas, Foreign, Problem, StrayClose, Unclosed};
use super::{Reader, Token, TokenKind};
use crate::form::{Form, FormKind};
use crate::source::Span;

impl Reader<'_> {
    /// True if a line begins with this token that was typed at the prompt of a shell. What was typed outside of all forms is stray
    /// text, unless it begins with a parenthesis.
    pub(super) fn is_at_prompt(&self, token: Token) -> bool {
        token.start == self.line_start
            && (token.kind == TokenKind::Open || !self.stack.is_empty())
            && is_prompt(self.text[token.start..].lines().next().unwrap_or(""))
    }

    /// Reports what was typed at a prompt: inside a form one line, which is left out.
    pub(super) fn prompt(&mut self, token: Token) {
        if self.stack.is_empty() {
            self.stray(token);
            return;
        }
        let line = self.text[token.start..].lines().next().unwrap_or("").trim_end();
        let span = self.span(token.start, token.start + line.len());
        self.pasted(span);
        self.problems.push(Problem::ForeignLines { first: span, is: Foreign::Prompt, lines: vec![span] });
        self.tokens.seek(token.start + line.len());
    }

    /// Notes that what follows may be another text, and that not all of it may be there.
    fn pasted(&mut self, span: Span) {
        self.problems.part(span);
        self.problems.lose_definitions();
    }

    /// Reports the form that is open and gives up all that are.
    pub(super) fn unclosed(&mut self, next: Option<usize>) {
        let outermost = self.stack.first().map_or(0, |open| open.at);
        let innermost =
            self.stack.iter().rev().find(|open| !open.mark.is_prefix()).map_or(outermost, |open| open.at);
        let at = self.suspect.map_or(innermost, |suspect| suspect.at);
        let missing = self.stack.iter().filter(|open| !open.mark.is_prefix()).count() + self.skipped;
        // A definition is shown with its name.
        let words = if begins_definition(&self.text[at..]) { 2 } else { 1 };
        let shown: Vec<&str> = self.text[at..]
            .split(|c: char| c.is_whitespace() || c == ')')
            .filter(|word| !word.is_empty())
            .take(words)
            .collect();
        // Where the lines are indented as if a form inside were closed, it ends before them, if it is the only one.
        let close_at = match self.suspect {
            Some(suspect) => (missing == 1).then_some(suspect.end),
            None => Some(self.last_end),
        };
        self.problems.push(Problem::Unclosed(Unclosed {
            at: self.span(at, at + 1),
            begins: shown.join(" "),
            missing,
            definition: (at != outermost).then(|| self.span(outermost, outermost + 1)),
            next: next.map(|next| self.span(next, next + 1)),
            close: close_at.filter(|_| self.skipped == 0).map(|end| self.span(end, end)),
        }));
        self.skipped = 0;
        // What there is of the form is kept, so that its name is known; other damage in it follows from this one.
        let end = next.unwrap_or(self.text.len());
        self.problems.mute(self.span(outermost, end));
        while let Some(open) = self.stack.pop() {
            let span = self.span(open.at, end);
            let form = if open.mark.is_prefix() {
                Form { span, kind: FormKind::Error }
            } else {
                Form { span, kind: FormKind::List(open.items) }
            };
            match self.stack.last_mut() {
                Some(top) => top.items.push(form),
                None => self.forms.push(form),
            }
        }
        self.suspect = None;
    }

    /// A `)` that closes nothing. Forms that fell out of the definition before it are taken back.
    pub(super) fn stray_close(&mut self, token: Token) {
        let mut end = token.end;
        loop {
            let next = self.tokens.peek();
            if next.kind != TokenKind::Close {
                break;
            }
            end = next.end;
            self.tokens.take();
        }
        let at_line_start = |form: &Form| {
            let start = form.span.start as usize;
            start == 0 || self.text.as_bytes().get(start - 1) == Some(&b'\n')
        };
        let mut closed_at = None;
        let mut fell_out = false;
        let spilled = self.forms.iter().rposition(at_line_start).map(|at| at + 1);
        if let Some(from) = spilled {
            // They belong to the definition: given back to it, what they call is in use.
            let lost = self.forms.split_off(from);
            fell_out = !lost.is_empty();
            if let Some(Form { kind: FormKind::List(items), span }) = self.forms.last_mut() {
                closed_at = Some(span.end as usize);
                if let Some(last) = lost.last() {
                    span.end = last.span.end;
                }
                items.extend(lost);
            }
        }
        let count = self.text[token.start..end].matches(')').count();
        let closed_early = self.closed_early.take();
        let same_at_end = |close: &usize| self.text[..*close].ends_with(&")".repeat(count));
        let first_word =
            |at: usize| self.text[at..].split(|c: char| c.is_whitespace() || c == ')').next().unwrap_or("");
        self.problems.push(Problem::StrayClose(StrayClose {
            at: self.span(token.start, end),
            count,
            closed: closed_at.map(|close| self.span(close.saturating_sub(1), close)),
            too_early: closed_at
                .filter(|_| fell_out)
                .filter(same_at_end)
                .map(|close| self.span(close - count, close)),
            are_the_ones: !fell_out && closed_early.is_none(),
            indented: closed_early.map(|(form, line)| (first_word(form), self.span(line, line + 1))),
        }));
        // Whatever else is wrong with the definition follows from that.
        if let (Some(_), Some(form)) = (closed_at, self.forms.last()) {
            self.problems.mute(form.span);
        }
    }

    /// Text outside all forms: reported once for a run of lines, which is left out.
    pub(super) fn stray(&mut self, token: Token) {
        let typed = is_prompt(self.text[token.start..].lines().next().unwrap_or(""));
        let mut end = token.start;
        for line in self.text[token.start..].split_inclusive('\n') {
            let continues = end == token.start || !(line.starts_with(['(', ';']) || line.starts_with("#|"));
            if !continues {
                break;
            }
            // What a command prints may quote a definition; one that follows it begins a line.
            let may_begin = |at: usize| !typed || line[..at].trim_start().is_empty();
            let mut marks = line.match_indices('(').filter(|(at, _)| may_begin(*at));
            if let Some(definition) = marks.find(|(at, _)| begins_definition(&line[*at..])) {
                end += definition.0;
                break;
            }
            end += line.len();
        }
        let shown = self.text[token.start..end].trim_end();
        let mut at = token.start;
        let lines: Vec<Span> = shown
            .split_inclusive('\n')
            .filter_map(|line| {
                let here = self.span(at, at);
                at += line.len();
                (!line.trim().is_empty()).then_some(here)
            })
            .collect();
        let line = shown.lines().next().unwrap_or("");
        let first = self.span(token.start, token.start + line.trim_end().len());
        if typed {
            self.pasted(first);
        }
        self.problems.push(match foreign_line(line) {
            Some(is) => Problem::ForeignLines { first, is, lines },
            None => Problem::Stray { first, word: line.split_whitespace().next().unwrap_or(line), lines },
        });
        self.problems.lose_text(shown);
        self.tokens.seek(end.max(token.end.min(self.text.len())).max(token.start + 1));
        self.line_start = self.text[..self.tokens.position()].rfind('\n').map_or(0, |n| n + 1);
    }
}

/// A number at the beginning of a text that has commas in it, and what those are there for.
pub(super) fn with_commas(text: &str) -> Option<(&str, Commas)> {
    /// What is longer is no number.
    const LONGEST: usize = 100;
    let of_number = |b: &u8| b.is_ascii_digit() || matches!(b, b',' | b'.' | b'+' | b'-');
    let end = text.bytes().take(LONGEST + 1).take_while(of_number).count();
    if end > LONGEST {
        return None;
    }
    let number = text[..end].trim_end_matches(',');
    let after = &text[number.len()..];
    let ends = after.is_empty()
        || after.starts_with(|c: char| c.is_whitespace() || matches!(c, '(' | ')' | ',' | ';'));
    let (first, rest) = number.split_once(',')?;
    let (groups, decimals) =
        rest.split_once('.').map_or((rest, None), |(groups, decimals)| (groups, Some(decimals)));
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    if !ends || !digits(first.trim_start_matches(['+', '-'])) || !groups.split(',').all(digits) {
        return None;
    }
    let thousands = groups.split(',').all(|group| group.len() == 3);
    match (thousands, decimals) {
        (true, decimals) if decimals.is_none_or(digits) => Some((number, Commas::Thousands)),
        (false, None) if groups.contains(',') => Some((number, Commas::Between)),
        (false, None) if digits(groups) => Some((number, Commas::Decimal)),
        _ => None,
    }
}
