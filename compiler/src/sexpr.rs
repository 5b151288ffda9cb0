//! Anything serialisable as an s-expression.

use lexpr::Value;
use serde::Serialize;

/// The value as one s-expression, in the form serde-lexpr gives it.
pub fn to_sexpr<T: Serialize>(value: &T) -> Result<String, serde_lexpr::Error> {
    let value = serde_lexpr::to_value(value)?;
    let text = value.to_string();
    dismantle(value);
    Ok(text)
}

/// Takes a value apart piece by piece: dropped as a whole, a long list recurses once for every element.
fn dismantle(value: Value) {
    let mut open = vec![value];
    while let Some(value) = open.pop() {
        match value {
            Value::Cons(cons) => {
                let (head, tail) = cons.into_pair();
                open.extend([head, tail]);
            }
            Value::Vector(items) => open.extend(items.into_vec()),
            _ => {}
        }
    }
}
