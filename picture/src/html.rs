//! A scene as a page of its own: nothing is fetched, nothing has to be built.

use crate::scene::Scene;
use crate::svg::{STYLE, escaped, svg};

/// Writes a scene as a page: to zoom and move in, to filter by name, and for an execution to go through.
pub fn html(scene: &Scene) -> String {
    let page = include_str!("page.html");
    let scrubber = if scene.items.iter().any(|item| item.known.is_some()) { "" } else { "hidden" };
    page.replace("{{title}}", &escaped(&scene.title))
        .replace("{{end}}", &scene.end.to_string())
        .replace("{{scrubber}}", scrubber)
        .replace("{{picture}}", &svg(scene).replace(&format!("<style>{STYLE}</style>"), ""))
        .replace("{{style}}", STYLE)
}
