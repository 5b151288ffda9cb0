//! Pictures of missions: a [`Chart`] says what is to be seen, a [`Scene`] where, and [`svg()`], [`html()`] and [`mermaid()`] write it.
//!
//! ```
//! use kirk_compiler::{Options, Source, compile};
//! use kirk_picture::{Chart, Look, Scene, svg};
//!
//! let text = "(define-control-program scan ()
//!   (declare (primitive) (duration (simple :lower-bound 15 :upper-bound 30) :contingent t)))
//! (define-control-program main () (sequence (:slack t) (scan)))";
//! let compilation = compile(&[Source::new("scan.rmpl", text)], &Options::default());
//! let (Some(episodes), Some(mission)) = (compilation.episodes, compilation.lowered) else { panic!("no mission") };
//! let chart = Chart::of_mission("main", &episodes, &mission.network);
//! assert!(svg(&Scene::new(&chart, Look::default())).contains("scan"));
//! ```

mod chart;
mod html;
mod lanes;
mod mermaid;
mod scene;
mod svg;
mod ticks;

pub use chart::{Bar, Chart, Moment, News, Whose};
pub use html::html;
pub use mermaid::mermaid;
pub use scene::{Item, Look, Scene, Shape};
pub use svg::svg;
