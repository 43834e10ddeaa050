use serde_json::{Map, Value};

/// What was measured, a row for every point.
pub struct Table {
    columns: &'static [&'static str],
    rows: Vec<Vec<Value>>,
}

impl Table {
    pub fn new(columns: &'static [&'static str]) -> Self {
        Self { columns, rows: Vec::new() }
    }

    /// A value for every column; null where there is none.
    pub fn push<const N: usize>(&mut self, row: [Value; N]) {
        assert_eq!(N, self.columns.len(), "a value for every column");
        self.rows.push(row.into());
    }

    /// A header, then a line a row; what is not there is left empty.
    pub fn csv(&self) -> String {
        let field = |value: &Value| match value {
            Value::Null => String::new(),
            Value::String(text) if text.contains([',', '"', '\n']) => {
                format!("\"{}\"", text.replace('"', "\"\""))
            }
            Value::String(text) => text.clone(),
            other => other.to_string(),
        };
        let line = |row: &Vec<Value>| row.iter().map(field).collect::<Vec<_>>().join(",") + "\n";
        self.columns.join(",") + "\n" + &self.rows.iter().map(line).collect::<String>()
    }

    /// The same as objects by the columns' names.
    pub fn told(&self) -> Value {
        let object = |row: &Vec<Value>| {
            let pairs = self.columns.iter().map(|c| (*c).to_owned()).zip(row.iter().cloned());
            Value::Object(pairs.collect::<Map<_, _>>())
        };
        self.rows.iter().map(object).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn lines_and_objects_say_the_same() {
        let mut table = Table::new(&["name", "error_px"]);
        table.push([json!("a, \"b\""), json!(1e-7)]);
        table.push([json!("c"), json!(f64::NAN)]);
        assert_eq!(table.csv(), "name,error_px\n\"a, \"\"b\"\"\",1e-7\nc,\n");
        assert_eq!(
            table.told(),
            json!([{ "name": "a, \"b\"", "error_px": 1e-7 }, { "name": "c", "error_px": null }])
        );
    }
}
