//! Examples in documents: every fenced block of YAML, TOML and JSON parses.

use std::path::{Path, PathBuf};

/// A fenced block: the line of its fence, its language, and its text without the fence's indentation.
struct Block {
    line: usize,
    language: String,
    text: String,
}

/// The fenced blocks of a document. A fence that nothing closes is a block up to the end.
fn blocks(document: &str) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::new();
    // The characters that close the block, and the columns that its lines are indented by
    let mut open: Option<(String, usize)> = None;
    for (index, line) in document.lines().enumerate() {
        let text = line.trim_start();
        let indent = line.len() - text.len();
        match &open {
            Some((fence, _)) if text.trim_end().starts_with(fence.as_str()) && text.trim_end().len() == fence.len() => {
                open = None;
            }
            Some((_, indent)) => {
                let rest = line.get(*indent..).filter(|_| line[..*indent].trim().is_empty()).unwrap_or(text);
                let block = blocks.last_mut().expect("an open block");
                block.text += rest;
                block.text.push('\n');
            }
            None if text.starts_with("```") || text.starts_with("~~~") => {
                let fence: String = text.chars().take_while(|&c| c == text.chars().next().unwrap()).collect();
                let info = text[fence.len()..].trim();
                let language = info.split([' ', ',', '{']).next().unwrap_or_default().to_lowercase();
                blocks.push(Block { line: index + 1, language, text: String::new() });
                open = Some((fence, indent));
            }
            None => {}
        }
    }
    blocks
}

/// Why a block does not parse in its language; `None` if it does, or for languages that are not checked.
fn problem(block: &Block) -> Option<String> {
    use saphyr::LoadableYamlNode;
    let why = match block.language.as_str() {
        "yaml" | "yml" => match saphyr::Yaml::load_from_str(&block.text) {
            Ok(documents) if documents.is_empty() => "it is empty".into(),
            Ok(_) => return None,
            Err(error) => error.to_string(),
        },
        "toml" => toml::from_str::<toml::Table>(&block.text).err()?.to_string(),
        "json" => serde_json::from_str::<serde_json::Value>(&block.text).err()?.to_string(),
        "jsonl" => {
            block.text.lines().find_map(|line| serde_json::from_str::<serde_json::Value>(line).err())?.to_string()
        }
        _ => return None,
    };
    Some(format!("line {}: {} block: {why}", block.line, block.language))
}

/// The documents of the project: those at its root, and all below `docs/`.
fn documents() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut documents = Vec::new();
    let mut folders = vec![(root.to_owned(), false), (root.join("docs"), true)];
    while let Some((folder, deep)) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() && deep {
                folders.push((path, true));
            } else if path.extension().is_some_and(|extension| extension == "md") {
                documents.push(path);
            }
        }
    }
    documents.sort();
    documents
}

#[test]
fn every_block_of_yaml_toml_and_json_parses() {
    let documents = documents();
    for name in ["README.md", "CONTRIBUTING.md", "docs/adding-a-workload.md"] {
        assert!(documents.iter().any(|path| path.ends_with(name)), "{name} is not checked");
    }
    let (mut problems, mut checked) = (Vec::new(), 0);
    for path in &documents {
        for block in blocks(&std::fs::read_to_string(path).unwrap()) {
            checked += usize::from(["yaml", "yml", "toml", "json", "jsonl"].contains(&block.language.as_str()));
            problems.extend(problem(&block).map(|problem| format!("{}: {problem}", path.display())));
        }
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
    assert!(checked > 0, "no block was found");
}

#[test]
fn a_broken_block_is_found() {
    let found = |document: &str| blocks(document).iter().find_map(problem);
    for (language, good, bad) in [
        ("yaml", "jobs:\n  gate:\n    steps:\n      - run: rtbench gate", "jobs:\n  - a\n b: [1,\n"),
        ("yml", "a: 1", "a: b: c"),
        ("yaml title=x", "a: |\n  ```sh", "\t- a: {"),
        ("toml", "passes = 3", "passes = "),
        ("json", "{\"a\": [1, 2]}", "{\"a\": [1, 2}"),
        ("jsonl", "{}\n[1]", "{}\n[1"),
    ] {
        let document = |text: &str| format!("Text\n\n````{language}\n{text}\n````\nmore: [text\n");
        assert_eq!(found(&document(good)), None, "{language}: {good}");
        let problem = found(&document(bad)).unwrap_or_else(|| panic!("{language}: {bad:?} parses"));
        assert!(problem.starts_with("line 3: "), "{problem}");
    }
    // In a list, with the list's indentation; and one that nothing closes
    assert_eq!(found("1. Step\n\n   ```yaml\n   a:\n     b: 1\n   ```\n"), None);
    assert!(found("1. Step\n\n   ```yaml\n   a: [\n   ```\n").is_some());
    assert!(found("```json\n{\n").is_some());
    assert!(found("```yaml\n```\n").is_some(), "an empty block");
    // Other languages are not looked at
    assert_eq!(found("```rust\nfn main( {\n```\n"), None);
    assert_eq!(blocks("```sh\na\n```\n~~~yaml\nb\n~~~\n").iter().map(|b| b.line).collect::<Vec<_>>(), [1, 4]);
}
