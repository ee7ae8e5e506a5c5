//! What maps and traces say, as plain data: groups, datasets and attributes with their names,
//! types, dimensions and fill values, in the order of the file. Whoever writes a file walks this
//! description.
//!
//! - `best`: the group of best settings, and its values plane by plane
//! - `cells`: the axes, the fixed parameters, the fields and the status
//! - `curve_column`: what a column of curves is called, and what its numbers belong to
//! - `curve_rows`: the curves of a plane as columns of numbers, declared once for the tiles, the
//!   map and its reader
//! - `curve_words`: the words for kinds, directions and sides of curves
//! - `curves`: the group of crossing curves
//! - `group_names`: names of parameters in the group of curves
//! - `root`: the attributes of a file: who made it, the sweep or case, the friction law
//! - `schema`: names, meanings and format version
//! - `summary`: the range of values of columns, and how many cells of each kind
//! - `trace`: a motion over time and its events

pub(crate) mod best;
mod cells;
pub(crate) mod curve_column;
pub mod curve_rows;
pub(crate) mod curve_words;
pub(crate) mod curves;
pub mod group_names;
pub mod root;
pub(crate) mod schema;
pub mod summary;
pub mod trace;

use super::plan::Plan;
use crate::answers::trace::Trace;
use crate::setting::case_file::CaseSpec;
use root::Provenance;

/// The attribute by which netCDF readers recognise elements without a value.
pub(crate) const FILL_VALUE: &str = "_FillValue";

/// A file: its dimensions and its groups.
///
/// ```
/// use slipmap::sweep::described::Described;
/// use slipmap::sweep::described::root::Provenance;
/// use slipmap::setting::SweepSpec;
/// use slipmap::sweep::Plan;
///
/// let sweep: SweepSpec = "[axes]\ntau = [1, 2, 3]\n[fixed]\nmu_prime = -0.3\n".parse()?;
/// let map = Described::of_map(&Plan::new(sweep)?, &Provenance::default());
/// let count = map.root().variable("n_unstable").unwrap();
/// assert_eq!(count.text("units"), Some("1"));
/// assert_eq!(map.dimensions[count.dimensions[0]].name, "tau");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Described {
    /// All dimensions, in the order in which they are declared.
    pub dimensions: Vec<Dimension>,
    /// The root, whose name is empty, then the other groups.
    pub groups: Vec<Group>,
}

/// A dimension.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Dimension {
    /// The group in which it stands; empty for the root.
    pub group: &'static str,
    /// Its name.
    pub name: String,
    /// Its length; none where it grows with what is computed.
    pub length: Option<usize>,
    /// Whether a variable of its name holds coordinates along it.
    pub coordinates: bool,
}

/// A group of variables.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// Its name; empty for the root.
    pub name: &'static str,
    /// Its attributes.
    pub attributes: Vec<Attribute>,
    /// Its variables.
    pub variables: Vec<Variable>,
}

/// A dataset.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// Its name in its group.
    pub name: String,
    /// The type of its elements.
    pub element: Element,
    /// Its dimensions, as places in [`Described::dimensions`]; none for a single number.
    pub dimensions: Vec<usize>,
    /// The element that stands for no value, where there can be such.
    pub fill: Option<f64>,
    /// Its attributes. Where integers have a fill value, `_FillValue` is added last if one is
    /// missing: with it, readers turn integers into floats.
    pub attributes: Vec<Attribute>,
    /// Its values, where they are known before anything is computed: coordinates and parameters.
    pub values: Option<Vec<f64>>,
    /// Whether it is the coordinate of its own dimension.
    pub is_scale: bool,
}

/// A type of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Element {
    /// i8.
    I8,
    /// i32.
    I32,
    /// i64.
    I64,
    /// u8.
    U8,
    /// u16.
    U16,
    /// f64.
    F64,
}

/// An attribute.
#[derive(Debug, Clone, PartialEq)]
pub struct Attribute {
    /// Its name.
    pub name: &'static str,
    /// Its value.
    pub value: Value,
}

/// The value of an attribute: a text, or numbers of one type.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A text.
    Text(String),
    /// The dimensions of the variable, as HDF5 refers to them.
    Dimensions,
    /// i8.
    I8(Vec<i8>),
    /// i32.
    I32(Vec<i32>),
    /// u8.
    U8(Vec<u8>),
    /// u16.
    U16(Vec<u16>),
    /// u32.
    U32(Vec<u32>),
    /// u64.
    U64(Vec<u64>),
    /// f64.
    F64(Vec<f64>),
}

macro_rules! value {
    ($($kind:ty: $variant:ident),*) => {$(
        impl From<&[$kind]> for Value {
            fn from(numbers: &[$kind]) -> Self {
                Self::$variant(numbers.to_vec())
            }
        }

        impl<const N: usize> From<[$kind; N]> for Value {
            fn from(numbers: [$kind; N]) -> Self {
                Self::$variant(numbers.into())
            }
        }
    )*};
}
value!(i8: I8, i32: I32, u8: U8, u16: U16, u32: U32, u64: U64, f64: F64);

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<String> for Value {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

/// An attribute with this name and value.
pub(super) fn attribute(name: &'static str, value: impl Into<Value>) -> Attribute {
    let value = value.into();
    Attribute { name, value }
}

/// The place of the dimensions among the attributes of a variable.
const DIMENSIONS: Attribute = Attribute {
    name: "DIMENSION_LIST",
    value: Value::Dimensions,
};

/// The meaning and the unit of a variable.
fn about(long_name: &str, unit: &str) -> [Attribute; 2] {
    [attribute("long_name", long_name), attribute("units", unit)]
}

/// The numbers of kinds, with the words for them.
fn flags(values: impl Into<Value>, meanings: &str) -> [Attribute; 2] {
    [
        attribute("flag_values", values),
        attribute("flag_meanings", meanings),
    ]
}

/// The attributes of kinds: the number k stands for `names[k]`.
fn kinds(long_name: &str, names: &[&str]) -> Vec<Attribute> {
    let numbers: Vec<u8> = (0..names.len() as u8).collect();
    let mut kinds = vec![attribute("long_name", long_name)];
    kinds.extend(flags(numbers.as_slice(), &names.join(" ")));
    kinds
}

impl Described {
    /// What the map of `plan` says before its cells are computed.
    #[must_use]
    pub fn of_map(plan: &Plan, provenance: &Provenance) -> Self {
        let mut dimensions = cells::dimensions(plan);
        let mut groups = vec![Group {
            name: "",
            attributes: root::of_map(plan, provenance),
            variables: cells::variables(plan),
        }];
        if let Some(plane) = plan.boundary_plane {
            groups.push(curves::group(plan, plane, dimensions.len()));
            dimensions.extend(curves::dimensions());
        }
        groups.extend(plan.best_plane().map(|plane| best::group(plan, plane)));
        Self { dimensions, groups }
    }

    /// What the trace of a motion says.
    #[must_use]
    pub fn of_trace(spec: &CaseSpec, trace: &Trace, provenance: &Provenance) -> Self {
        Self {
            dimensions: trace::dimensions(trace),
            groups: trace::groups(spec, trace, provenance),
        }
    }

    /// The root.
    #[must_use]
    pub fn root(&self) -> &Group {
        &self.groups[0]
    }

    /// The group with this name.
    #[must_use]
    pub(crate) fn group(&self, name: &str) -> Option<&Group> {
        self.groups.iter().find(|group| group.name == name)
    }

    /// The length of each dimension of a variable, 0 where it grows.
    #[must_use]
    pub(crate) fn shape(&self, variable: &Variable) -> Vec<usize> {
        let dimensions = variable.dimensions.iter();
        let length = |&place: &usize| self.dimensions[place].length.unwrap_or(0);
        dimensions.map(length).collect()
    }
}

impl Group {
    /// The variable with this name.
    #[must_use]
    pub fn variable(&self, name: &str) -> Option<&Variable> {
        let mut variables = self.variables.iter();
        variables.find(|variable| variable.name == name)
    }
}

impl Variable {
    /// A variable whose values are computed, over these dimensions.
    fn computed(name: impl Into<String>, element: Element, dimensions: Vec<usize>) -> Self {
        Self {
            name: name.into(),
            element,
            dimensions,
            fill: None,
            attributes: Vec::new(),
            values: None,
            is_scale: false,
        }
    }

    /// Reals whose values are known, over these dimensions.
    fn known(name: &str, dimensions: Vec<usize>, values: Vec<f64>) -> Self {
        Self {
            values: Some(values),
            ..Self::computed(name, Element::F64, dimensions)
        }
    }

    /// The text of an attribute.
    #[must_use]
    pub fn text(&self, name: &str) -> Option<&str> {
        let mut attributes = self.attributes.iter();
        match &attributes.find(|of| of.name == name)?.value {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }
}
