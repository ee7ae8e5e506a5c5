//! The pages of the guide as their links, headings and blocks of code.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Component, Path, PathBuf};

use pulldown_cmark::{CodeBlockKind, Event, Options, Parser, Tag, TagEnd};

/// A block of code.
pub(crate) struct Block {
    /// Its language.
    pub(crate) language: String,
    /// The file that it stands for, where its info says `file=NAME`; else empty.
    pub(crate) name: String,
    /// What is in it.
    pub(crate) text: String,
}

impl Block {
    /// Commands of a block of shell, without their comments, continued lines put together.
    pub(crate) fn commands(&self) -> Vec<String> {
        let text = self.text.replace("\\\n", " ");
        let lines = text.lines().map(|line| {
            let line = line.split(" # ").next().unwrap();
            line.split_whitespace().collect::<Vec<_>>().join(" ")
        });
        lines
            .filter(|line| !line.is_empty() && !line.starts_with('#'))
            .collect()
    }
}

/// A page.
pub(crate) struct Page {
    pub(crate) path: PathBuf,
    pub(crate) text: String,
    /// What headings are called in links.
    pub(crate) anchors: BTreeSet<String>,
    pub(crate) blocks: Vec<Block>,
    links: Vec<String>,
}

impl Page {
    fn read(path: &Path) -> Self {
        let text = std::fs::read_to_string(path).unwrap();
        let mut page = Self {
            path: path.to_owned(),
            text,
            anchors: BTreeSet::new(),
            blocks: Vec::new(),
            links: Vec::new(),
        };
        let text = page.text.clone();
        let mut heading: Option<String> = None;
        let mut block: Option<Block> = None;
        for event in Parser::new_ext(&text, Options::ENABLE_TABLES) {
            match event {
                Event::Start(Tag::Heading { .. }) => heading = Some(String::new()),
                Event::End(TagEnd::Heading(_)) => page.head(&heading.take().unwrap()),
                Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => {
                    page.links.push(dest_url.into_string());
                }
                Event::Start(Tag::CodeBlock(CodeBlockKind::Fenced(info))) => {
                    let mut words = info.split([' ', ',']);
                    let language = words.next().unwrap_or_default().to_owned();
                    let name = words.find_map(|word| word.strip_prefix("file="));
                    block = Some(Block {
                        language,
                        name: name.unwrap_or_default().to_owned(),
                        text: String::new(),
                    });
                }
                Event::End(TagEnd::CodeBlock) => page.blocks.extend(block.take()),
                Event::Text(text) | Event::Code(text) => {
                    if let Some(block) = &mut block {
                        block.text.push_str(&text);
                    } else if let Some(heading) = &mut heading {
                        heading.push_str(&text);
                    }
                }
                _ => {}
            }
        }
        page
    }

    /// The anchor of a heading, as mdBook and GitHub make it.
    fn head(&mut self, heading: &str) {
        let heading = heading.to_lowercase();
        let kept = heading.chars().filter_map(|c| match c {
            ' ' => Some('-'),
            c if c.is_alphanumeric() || "-_".contains(c) => Some(c),
            _ => None,
        });
        self.anchors.insert(kept.collect());
    }

    /// Links to files and their anchors; those to other places are left out.
    pub(crate) fn links(&self) -> impl Iterator<Item = (PathBuf, Option<String>)> {
        let local = self.links.iter().filter(|link| !link.contains("://"));
        local.map(|link| {
            let (file, anchor) = match link.split_once('#') {
                Some((file, anchor)) => (file, Some(anchor.to_owned())),
                None => (&**link, None),
            };
            let folder = self.path.parent().unwrap();
            match file {
                "" => (self.path.clone(), anchor),
                file => (plain(&folder.join(file)), anchor),
            }
        })
    }
}

/// A path without `..`.
fn plain(path: &Path) -> PathBuf {
    let mut parts = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => drop(parts.pop()),
            other => parts.push(other),
        }
    }
    parts
}

fn collect(folder: &Path, pages: &mut BTreeMap<PathBuf, Page>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            collect(&path, pages);
        } else if path.extension().is_some_and(|of| of == "md") {
            pages.insert(path.clone(), Page::read(&path));
        }
    }
}

/// README.md and all pages below doc, by their paths.
pub(crate) fn pages() -> BTreeMap<PathBuf, Page> {
    let mut pages = BTreeMap::new();
    collect(Path::new("doc"), &mut pages);
    let readme = Path::new("README.md");
    pages.insert(readme.to_owned(), Page::read(readme));
    pages
}
