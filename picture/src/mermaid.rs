//! A chart as a Gantt chart of Mermaid, which many pages draw by themselves.

use std::fmt::Write;

use crate::chart::{Bar, Chart, Whose};

/// Writes a chart as a Gantt chart. Times are milliseconds; what is shorter is as long as one.
pub fn mermaid(chart: &Chart) -> String {
    let mut text =
        format!("gantt\n    title {}\n    dateFormat x\n    axisFormat %H:%M:%S\n", plain(&chart.title));
    let mut row = usize::MAX;
    let mut bars: Vec<&Bar> = chart.bars.iter().filter(|bar| bar.around == 0).collect();
    bars.sort_by_key(|bar| (bar.row, bar.start.at(), bar.end.at()));
    for bar in bars {
        if bar.row != row {
            row = bar.row;
            let _ = writeln!(text, "    section {}", row + 1);
        }
        let tags = match (bar.is_blamed, bar.whose) {
            (true, _) => "crit, ",
            (false, Whose::Natures) => "active, ",
            (false, Whose::Ours) => "",
        };
        let (start, end) = (bar.start.at().as_micros() / 1_000, bar.end.at().as_micros() / 1_000);
        let _ = writeln!(text, "    {} :{tags}{start}, {}", plain(&bar.name), end.max(start + 1));
    }
    text
}

/// Mermaid ends a name at a colon, and takes some signs for its own.
fn plain(text: &str) -> String {
    text.chars()
        .map(|letter| if ":;#,%\n".contains(letter) || letter.is_control() { ' ' } else { letter })
        .collect()
}
