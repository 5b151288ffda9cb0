//! A scene as SVG: light or dark as the reader has it, and black on white where it is printed.

use std::fmt::Write;

use crate::scene::{Anchor, Item, Scene, Shape};

/// Plain rules: not every program that shows SVG knows variables.
pub(crate) const STYLE: &str = "\
.kirk{background:#fff;font:11px ui-sans-serif,system-ui,Helvetica,Arial,'DejaVu Sans',sans-serif}\
.kirk text{fill:#1f2328}.kirk .title{font-size:18px;font-weight:600}.kirk .says,.kirk .tick,.kirk .legend,.kirk .form{fill:#57606a}.kirk .note{white-space:pre}.kirk .agent{font-size:13px;font-weight:600}\
.kirk .paper{fill:#fff}.kirk .grid{stroke:#e6e8eb}.kirk .ours{fill:#2f6fde}.kirk .natures{fill:#d98200}\
.kirk .open{fill:url(#kirk-open);stroke:#d98200;stroke-width:.8}.kirk .around{fill:none;stroke:#8c959f;stroke-dasharray:2 3}\
.kirk .whisker{stroke:#6e7781;stroke-width:1.2}.kirk .limit{stroke:#cf222e;stroke-width:2;stroke-dasharray:5 3}\
.kirk .blamed{stroke:#cf222e;stroke-width:2.4}.kirk .heard{stroke:#1a7f37;stroke-width:1.6}\
.kirk .truth{fill:#fff;stroke:#1f2328;stroke-width:1.4}.kirk .acted,.kirk .held,.kirk .imagined{stroke:#1f2328;stroke-width:2}\
.kirk .imagined{stroke-dasharray:2 2}.kirk .held{stroke-dasharray:7 2}.kirk text.inside{fill:#fff;font-weight:600}\
.kirk .later{opacity:.15}.kirk .other{opacity:.12}\
@media (prefers-color-scheme:dark){.kirk{background:#0d1117}.kirk .paper{fill:#0d1117}.kirk text{fill:#e6edf3}\
.kirk .says,.kirk .tick,.kirk .legend,.kirk .form{fill:#9198a1}.kirk .grid{stroke:#21262d}.kirk .ours{fill:#3d78e0}.kirk .natures{fill:#b36b00}\
.kirk .whisker,.kirk .around{stroke:#9198a1}.kirk .truth{fill:#0d1117;stroke:#e6edf3}\
.kirk .acted,.kirk .held,.kirk .imagined{stroke:#e6edf3}.kirk .limit,.kirk .blamed{stroke:#ff6b6b}.kirk .heard{stroke:#3fb950}}\
@media print{.kirk,.kirk .paper{background:#fff;fill:#fff}.kirk text{fill:#000}}";

/// Writes a scene as SVG.
pub fn svg(scene: &Scene) -> String {
    let Scene { width, height, title, says, items, plot, end, .. } = scene;
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"kirk\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" \
         height=\"{height}\" role=\"img\" aria-label=\"{0}\" data-from=\"{1}\" data-to=\"{2}\" data-end=\"{end}\">\
         <title>{0}: {3}</title><style>{STYLE}</style><defs><pattern id=\"kirk-open\" width=\"6\" height=\"6\" \
         patternUnits=\"userSpaceOnUse\" patternTransform=\"rotate(45)\"><line y2=\"6\" stroke=\"#d98200\" \
         stroke-width=\"3\" stroke-opacity=\".55\"/></pattern><marker id=\"kirk-news\" viewBox=\"0 0 8 8\" refX=\"7\" \
         refY=\"4\" markerWidth=\"6\" markerHeight=\"6\" orient=\"auto\"><path d=\"M0 0L8 4L0 8z\" fill=\"#1a7f37\"/>\
         </marker></defs>\n",
        escaped(title),
        plot.0,
        plot.1,
        escaped(says),
    );
    let _ = writeln!(text, "<rect class=\"paper\" width=\"{width}\" height=\"{height}\"/>");
    let _ = writeln!(text, "<text class=\"title\" x=\"{}\" y=\"30\">{}</text>", plot.0, escaped(title));
    let _ = writeln!(text, "<text class=\"says\" x=\"{}\" y=\"50\">{}</text>", plot.0, escaped(says));
    // What belongs to one bar is one group, and says once what there is to say.
    let mut told = vec![false; scene.bars.len()];
    for group in items.chunk_by(|one, other| one.of == other.of) {
        let Some(of) = group[0].of else {
            group.iter().for_each(|item| write(item, &mut text));
            continue;
        };
        let (name, hint) = &scene.bars[of];
        let _ = write!(text, "<g data-of=\"{}\">", escaped(name));
        if !std::mem::replace(&mut told[of], true) {
            let _ = writeln!(text, "<title>{}</title>", escaped(hint));
        }
        group.iter().for_each(|item| write(item, &mut text));
        text.push_str("</g>\n");
    }
    text.push_str("</svg>\n");
    text
}

fn write(Item { shape, class, known, .. }: &Item, text: &mut String) {
    let known = known.map_or(String::new(), |known| format!(" data-known=\"{known}\""));
    let about = format!("class=\"{class}\"{known}");
    let _ = match shape {
        Shape::Box([x, y, w, h]) => {
            let (x, y, w, h) = (round(*x), round(*y), round(*w), round(*h));
            writeln!(text, "<rect {about} x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" rx=\"2\"/>")
        }
        Shape::Line(points) => writeln!(text, "<line {about} {}/>", ends(*points)),
        Shape::Arrow(points) => {
            writeln!(text, "<line {about} {} marker-end=\"url(#kirk-news)\"/>", ends(*points))
        }
        Shape::Diamond([x, y]) => {
            writeln!(text, "<path {about} d=\"M{} {}m-5 0l5 -5l5 5l-5 5z\"/>", round(*x), round(*y))
        }
        Shape::Words { at: [x, y], anchor, text: words } => {
            let middle = if *anchor == Anchor::Middle { " text-anchor=\"middle\"" } else { "" };
            let (x, y) = (round(*x), round(*y));
            writeln!(text, "<text {about} x=\"{x}\" y=\"{y}\"{middle}>{}</text>", escaped(words))
        }
    };
}

fn ends([x1, y1, x2, y2]: [f64; 4]) -> String {
    format!("x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\"", round(x1), round(y1), round(x2), round(y2))
}

/// A tenth of a pixel is as much as anybody sees.
fn round(number: f64) -> f64 {
    (number * 10.0).round() / 10.0
}

/// As text and in attributes of XML. What XML has no place for is left out.
pub(crate) fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\n' | '\t' => escaped.push(letter),
            letter if letter.is_control() => escaped.push('\u{fffd}'),
            letter => escaped.push(letter),
        }
    }
    escaped
}
