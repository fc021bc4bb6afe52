//! JSON Schema of what a run writes, made of the types that write it. `docs/schema/` has it as files, and a test
//! compares both.

use super::journal::{Record, RunDocument};
use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde_json::Value;

/// The schema of a line of `journal.jsonl`: what this version reads.
pub fn journal() -> Value {
    let title = "A line of an rtbench journal (journal.jsonl)";
    of::<Record>(title, SchemaSettings::draft2020_12().for_deserialize())
}

/// The schema of `run.json`: what this version writes.
pub fn run() -> Value {
    let title = "An rtbench run as one document (run.json)";
    of::<RunDocument>(title, SchemaSettings::draft2020_12().for_serialize())
}

/// The schema of a type, with a title.
pub fn of<T: JsonSchema>(title: &str, settings: SchemaSettings) -> Value {
    let mut schema = settings.into_generator().into_root_schema_for::<T>();
    schema.insert("title".into(), title.into());
    let mut schema = schema.to_value();
    plain(&mut schema);
    schema
}

/// Turns what rustdoc has in descriptions into what a reader of JSON knows: links such as [`a::b`] into `b`, and `None`
/// into null.
fn plain(value: &mut Value) {
    match value {
        Value::Object(object) => {
            for (key, value) in object {
                match value {
                    Value::String(text) if key == "description" => {
                        *text = without_links(text).replace("`None`", "null")
                    }
                    _ => plain(value),
                }
            }
        }
        Value::Array(list) => list.iter_mut().for_each(plain),
        _ => {}
    }
}

fn without_links(text: &str) -> String {
    let mut plain = String::new();
    for (index, part) in text.split("[`").enumerate() {
        match part.split_once("`]") {
            Some((path, rest)) if index > 0 => {
                let name = path.rsplit("::").next().unwrap_or(path);
                plain += &format!("`{name}`{rest}");
            }
            _ => plain += part,
        }
    }
    plain
}
