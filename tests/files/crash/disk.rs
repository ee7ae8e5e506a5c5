//! Files and folders, and what a loss of power can leave of changes to them.
//!
//! What was synced is there: the bytes of a file that was, the entries of a folder that was. Of
//! everything else any part may be, in any order: a new name before the bytes of its file, a
//! removal before a rename, blocks of a write without the others, a length without its bytes. This
//! is more than any file system does; what stands this stands ext4, xfs and btrfs.

use std::collections::BTreeMap;
use std::fs::File;
use std::path::Path;
use std::time::{Duration, SystemTime};

const HOUR: Duration = Duration::from_secs(3600);

/// Which node.
pub(crate) type Number = usize;

/// A name in a folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Name(pub Number, pub String);

/// A file or a folder.
#[derive(Debug, Clone)]
pub(crate) enum Node {
    File(Vec<u8>),
    Folder(BTreeMap<String, Number>),
}

impl Node {
    pub(crate) fn folder() -> Self {
        Self::Folder(BTreeMap::new())
    }
}

/// One change.
#[derive(Debug, Clone)]
pub(crate) enum Change {
    Link {
        name: Name,
        node: Number,
    },
    Rename {
        from: Name,
        to: Name,
        node: Number,
    },
    Unlink {
        name: Name,
        node: Number,
    },
    Write {
        node: Number,
        at: usize,
        data: Vec<u8>,
    },
    Truncate {
        node: Number,
        size: usize,
    },
    Sync {
        node: Number,
    },
}

impl Change {
    /// Whether it is one of what is in a file.
    pub(crate) fn is_of_data(&self) -> bool {
        matches!(self, Self::Write { .. } | Self::Truncate { .. })
    }

    /// What it is, without its bytes.
    pub(crate) fn in_short(&self) -> String {
        match self {
            Self::Write { node, at, data } => format!("{} bytes at {at} of {node}", data.len()),
            other => format!("{other:?}"),
        }
    }

    /// Whether the sync of a node makes it last.
    fn lasts_with(&self, synced: Number) -> bool {
        match self {
            Self::Write { node, .. } | Self::Truncate { node, .. } => *node == synced,
            Self::Link { name, .. } | Self::Unlink { name, .. } => name.0 == synced,
            Self::Rename { from, to, .. } => from.0 == synced || to.0 == synced,
            Self::Sync { .. } => true,
        }
    }
}

/// What a sync after each of some changes makes of them: whether they are sure to last.
pub(crate) fn lasting(changes: &[Change]) -> Vec<bool> {
    let mut lasting = vec![false; changes.len()];
    for (i, change) in changes.iter().enumerate() {
        if let Change::Sync { node } = change {
            for (before, lasts) in changes[..=i].iter().zip(&mut lasting) {
                *lasts |= before.lasts_with(*node);
            }
        }
    }
    lasting
}

/// All files and folders.
#[derive(Debug, Clone)]
pub(crate) struct Disk(Vec<Node>);

impl Default for Disk {
    fn default() -> Self {
        Self(vec![Node::folder()])
    }
}

impl Disk {
    pub(crate) const ROOT: Number = 0;

    /// A new node without a name.
    pub(crate) fn add(&mut self, node: Node) -> Number {
        self.0.push(node);
        self.0.len() - 1
    }

    /// How many nodes there are.
    pub(crate) fn nodes(&self) -> usize {
        self.0.len()
    }

    /// The same files and folders with those that `other` has besides, as they are when they are
    /// new.
    pub(crate) fn with_nodes_of(&self, other: &Self) -> Self {
        let mut nodes = self.0.clone();
        for node in &other.0[nodes.len()..] {
            nodes.push(match node {
                Node::File(_) => Node::File(Vec::new()),
                Node::Folder(_) => Node::folder(),
            });
        }
        Self(nodes)
    }

    pub(crate) fn entries(&mut self, folder: Number) -> &mut BTreeMap<String, Number> {
        match &mut self.0[folder] {
            Node::Folder(entries) => entries,
            Node::File(_) => panic!("a file is no folder"),
        }
    }

    pub(crate) fn bytes(&mut self, file: Number) -> &mut Vec<u8> {
        match &mut self.0[file] {
            Node::File(bytes) => bytes,
            Node::Folder(_) => panic!("a folder is no file"),
        }
    }

    pub(crate) fn is_folder(&self, node: Number) -> bool {
        matches!(self.0[node], Node::Folder(_))
    }

    /// What has a name.
    pub(crate) fn at(&self, name: &Name) -> Option<Number> {
        match &self.0[name.0] {
            Node::Folder(entries) => entries.get(&name.1).copied(),
            Node::File(_) => None,
        }
    }

    pub(crate) fn apply(&mut self, change: &Change) {
        match change {
            Change::Link { name, node } => drop(self.entries(name.0).insert(name.1.clone(), *node)),
            Change::Rename { from, to, node } => {
                self.remove(from, *node);
                self.entries(to.0).insert(to.1.clone(), *node);
            }
            Change::Unlink { name, node } => self.remove(name, *node),
            Change::Write { node, at, data } => self.write(*node, *at, data),
            Change::Truncate { node, size } => self.bytes(*node).resize(*size, 0),
            Change::Sync { .. } => {}
        }
    }

    /// Without what came before it, a change finds something else by that name, and leaves it.
    fn remove(&mut self, name: &Name, node: Number) {
        if self.at(name) == Some(node) {
            self.entries(name.0).remove(&name.1);
        }
    }

    pub(crate) fn write(&mut self, file: Number, at: usize, data: &[u8]) {
        let bytes = self.bytes(file);
        bytes.resize(bytes.len().max(at + data.len()), 0);
        bytes[at..at + data.len()].copy_from_slice(data);
    }

    /// Every path with the bytes of its file; folders have none.
    pub(crate) fn listing(&self) -> BTreeMap<String, Option<&[u8]>> {
        let all = self.paths().into_iter();
        all.map(|(path, node)| match &self.0[node] {
            Node::File(bytes) => (path, Some(&bytes[..])),
            Node::Folder(_) => (path, None),
        })
        .collect()
    }

    /// Every path, those of folders before those of what is in them.
    fn paths(&self) -> Vec<(String, Number)> {
        let (mut paths, mut next) = (Vec::new(), vec![(String::new(), Self::ROOT)]);
        while let Some((path, node)) = next.pop() {
            if let Node::Folder(entries) = &self.0[node] {
                let inner = |(name, &node): (&String, &Number)| (format!("{path}/{name}"), node);
                next.extend(entries.iter().map(inner));
            }
            if node != Self::ROOT {
                paths.push((path, node));
            }
        }
        paths
    }

    /// Writes all of it to an empty folder. Nodes before `new` are an hour old.
    pub(crate) fn put(&self, folder: &Path, new: Number) {
        for (path, node) in self.paths() {
            let path = folder.join(&path[1..]);
            match &self.0[node] {
                Node::Folder(_) => std::fs::create_dir(path).unwrap(),
                Node::File(bytes) => {
                    std::fs::write(&path, bytes).unwrap();
                    if node < new {
                        let file = File::options().write(true).open(path).unwrap();
                        file.set_modified(SystemTime::now() - HOUR).unwrap();
                    }
                }
            }
        }
    }
}
