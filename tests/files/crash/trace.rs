//! What a command did to the files of a folder, as `tests/faults/interpose.c` recorded it.

use std::collections::HashMap;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

use super::disk::{Change, Disk, Name, Node, Number};

/// A folder before a command, and the changes by it, in order.
pub(crate) struct Trace {
    pub before: Disk,
    /// Nodes from here on are new.
    pub new: Number,
    pub changes: Vec<Change>,
}

impl Trace {
    /// Of a command that works in `folder` and leaves its record at `record`.
    pub(crate) fn of(folder: &Path, record: &Path, command: impl FnOnce()) -> Self {
        let (mut before, mut inodes) = (Disk::default(), Inodes::new());
        take_in(folder, Disk::ROOT, &mut before, &mut inodes);
        command();
        let record = std::fs::read(record).unwrap();
        let mut reader = Reader {
            rest: &record,
            folder: folder.canonicalize().unwrap(),
            inodes,
            now: before.clone(),
        };
        let mut changes = Vec::new();
        while !reader.rest.is_empty() {
            let change = reader.change();
            reader.now.apply(&change);
            changes.push(change);
        }
        let mut found = Disk::default();
        take_in(folder, Disk::ROOT, &mut found, &mut Inodes::new());
        // Had a call gone by unseen, the two would differ.
        assert!(
            reader.now.listing() == found.listing(),
            "a hole in the trace"
        );
        Self {
            new: before.nodes(),
            before: before.with_nodes_of(&reader.now),
            changes,
        }
    }
}

/// Which inode is which node.
type Inodes = HashMap<u64, Number>;

fn take_in(folder: &Path, at: Number, disk: &mut Disk, inodes: &mut Inodes) {
    inodes.insert(folder.metadata().unwrap().ino(), at);
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        let is_folder = path.is_dir();
        let node = disk.add(match is_folder {
            true => Node::folder(),
            false => Node::File(std::fs::read(&path).unwrap()),
        });
        inodes.insert(path.metadata().unwrap().ino(), node);
        disk.apply(&Change::Link {
            name: Name(at, name),
            node,
        });
        if is_folder {
            take_in(&path, node, disk, inodes);
        }
    }
}

/// Goes through a record, with the folder as the command saw it at hand.
struct Reader<'a> {
    rest: &'a [u8],
    folder: PathBuf,
    inodes: Inodes,
    now: Disk,
}

impl Reader<'_> {
    fn bytes(&mut self, n: u64) -> Vec<u8> {
        let (bytes, rest) = self.rest.split_at(n as usize);
        self.rest = rest;
        bytes.to_vec()
    }

    fn change(&mut self) -> Change {
        let head = self.bytes(48);
        let number = |i: usize| u64::from_le_bytes(*head[8 * i..].first_chunk().unwrap());
        let [what, inode, at] = [0, 1, 2].map(number);
        let [name, other, data] = [3, 4, 5].map(|i| self.bytes(number(i)));
        let known = |reader: &Self| reader.inodes[&inode];
        match what {
            1 => self.link(&name, inode, Node::File(Vec::new())),
            2 => Change::Write {
                node: known(self),
                at: at as usize,
                data,
            },
            3 => Change::Truncate {
                node: known(self),
                size: at as usize,
            },
            4 => Change::Sync { node: known(self) },
            5 => {
                let (from, to) = (self.name(&name), self.name(&other));
                let node = self.now.at(&from).unwrap();
                Change::Rename { from, to, node }
            }
            6 | 7 => {
                let name = self.name(&name);
                let node = self.now.at(&name).unwrap();
                Change::Unlink { name, node }
            }
            8 => self.link(&name, inode, Node::folder()),
            _ => panic!("what is {what}?"),
        }
    }

    fn link(&mut self, name: &[u8], inode: u64, node: Node) -> Change {
        let name = self.name(name);
        let node = self.now.add(node);
        self.inodes.insert(inode, node);
        Change::Link { name, node }
    }

    /// The folder that a name is in, and the rest of it.
    fn name(&self, path: &[u8]) -> Name {
        let path = Path::new(std::str::from_utf8(path).unwrap());
        let path = path.strip_prefix(&self.folder).unwrap_or(path);
        let mut at = Disk::ROOT;
        let last = path.file_name().unwrap().to_str().unwrap();
        for folder in path.parent().into_iter().flat_map(Path::components) {
            let name = folder.as_os_str().to_str().unwrap();
            if name != "." {
                at = self.now.at(&Name(at, name.to_owned())).unwrap();
            }
        }
        Name(at, last.to_owned())
    }
}
