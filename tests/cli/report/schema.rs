//! The schema of the report, generated from the types.

use contact_dd_mpi::output::report::Report;
use schemars::Schema;
use schemars::generate::SchemaSettings;
use schemars::transform::RecursiveTransform;
use serde_json::{Value, json};

/// The schema in the docs, which allows additional fields, as later versions may write more.
pub fn published() -> Value {
    let settings = SchemaSettings::draft2020_12()
        .for_serialize()
        .with_transform(RecursiveTransform(as_written));
    let mut schema = settings
        .into_generator()
        .into_root_schema_for::<Report>()
        .to_value();
    schema["title"] = json!("Report of contact-dd-mpi");
    schema
}

/// The types in their JSON form: a number that isn't finite is null.
fn as_written(schema: &mut Schema) {
    // Rust's type names aren't formats of JSON.
    schema.remove("format");
    if schema.get("type") == Some(&json!("number")) {
        schema.insert("type".into(), json!(["number", "null"]));
    }
    // Line breaks in doc comments have no meaning.
    if let Some(Value::String(text)) = schema.get_mut("description") {
        *text = text.replace('\n', " ");
    }
}

/// Forbids all unknown fields.
pub fn close(schema: &mut Value) {
    match schema {
        Value::Object(fields) => {
            fields.values_mut().for_each(close);
            if fields.get("properties").is_some_and(Value::is_object) {
                fields.insert("additionalProperties".into(), json!(false));
            }
        }
        Value::Array(items) => items.iter_mut().for_each(close),
        _ => {}
    }
}
