//! Where an amount stands in an element of a network file, for who wants to change it there.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;

use serde_json::value::RawValue;

use crate::conflict::Part;

/// The bytes of an amount in the text of its element, `{"from": "a", "to": "b", "upper": 5}`; `None` if it is not there, or the
/// text is no such element.
pub fn amount_in(element: &str, part: Part) -> Option<Range<usize>> {
    let fields: BTreeMap<Cow<'_, str>, &RawValue> = serde_json::from_str(element).ok()?;
    let value = match part {
        Part::RequirementLower(_) | Part::LinkLower(_) => fields.get("lower")?.get(),
        Part::RequirementUpper(_) | Part::LinkUpper(_) => fields.get("upper")?.get(),
        Part::DelayMin(_) | Part::DelayMax(_) => {
            let delay: Vec<&RawValue> = serde_json::from_str(fields.get("delay")?.get()).ok()?;
            delay.get(usize::from(matches!(part, Part::DelayMax(_))))?.get()
        }
        Part::AfterOrigin | Part::Join(_) => return None,
    };
    let start = (value.as_ptr() as usize).checked_sub(element.as_ptr() as usize)?;
    Some(start..start + value.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn amounts_are_found_where_they_stand() {
        let element = r#"{"from": "lower", "delay" : [1.5, null],"upper":20 }"#;
        let found = |part| amount_in(element, part).map(|at| &element[at]);
        assert_eq!(found(Part::LinkUpper(3)), Some("20"));
        assert_eq!(found(Part::LinkLower(3)), None);
        assert_eq!(found(Part::DelayMin(3)), Some("1.5"));
        assert_eq!(found(Part::DelayMax(3)), Some("null"));
        assert_eq!(amount_in("<edge>", Part::LinkUpper(0)), None);
    }
}
