//! Tables for people: columns as wide as they have to be, and a text behind them in lines that fit a terminal.

/// No line is longer, unless one word of it is.
const WIDTH: usize = 80;

/// A text beside columns is never squeezed into less.
const NARROWEST: usize = 30;

/// A row: what stands in the columns, a text, and the place that it is about.
pub(crate) struct Row<const N: usize> {
    pub(crate) cells: [String; N],
    pub(crate) text: String,
    pub(crate) place: Option<String>,
}

/// An empty line, the heads, and the rows.
pub(crate) fn table<const N: usize>(heads: [&str; N], title: &str, rows: &[Row<N>]) -> Vec<String> {
    let wide = |column: usize| {
        let cells = rows.iter().map(|row| row.cells[column].chars().count());
        cells.chain([heads[column].chars().count()]).max().unwrap_or_default()
    };
    let widths: [usize; N] = std::array::from_fn(wide);
    let lead = |cells: [&str; N]| {
        let cells = cells.iter().zip(widths).map(|(cell, width)| format!("  {cell:>width$}"));
        cells.collect::<String>() + "  "
    };
    let mut lines = vec![String::new(), lead(heads) + title];
    for row in rows {
        let lead = lead(row.cells.each_ref().map(String::as_str));
        let indent = lead.chars().count();
        let mut told = wrapped(&lead, &row.text);
        match (told.last_mut(), &row.place) {
            (Some(last), Some(place)) if last.chars().count() + 2 + place.chars().count() <= WIDTH => {
                last.push_str(&format!("  {place}"));
            }
            (_, Some(place)) => {
                // A place is of no use in pieces: a long one begins farther to the left.
                let indent = indent.min(WIDTH.saturating_sub(place.chars().count())).max(4);
                told.push(format!("{:indent$}{place}", ""));
            }
            (_, None) => {}
        }
        lines.extend(told);
    }
    lines
}

/// A text in lines that are not too long, those after the first indented below it.
pub(crate) fn wrapped(lead: &str, text: &str) -> Vec<String> {
    let indent = lead.chars().count();
    let most = WIDTH.max(indent + NARROWEST);
    let mut lines = vec![lead.to_string()];
    for word in text.split(' ') {
        let Some(last) = lines.last_mut() else { break };
        let length = last.chars().count();
        if length <= indent {
            last.push_str(word);
        } else if length + 1 + word.chars().count() <= most {
            last.push_str(&format!(" {word}"));
        } else {
            lines.push(format!("{:indent$}{word}", ""));
        }
    }
    lines
}
