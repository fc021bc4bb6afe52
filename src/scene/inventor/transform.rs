//! Transform nodes. The format has row vectors: its matrices are stored by rows, and a point is transformed by the
//! innermost transform first.

use super::node_type::NodeType;
use super::state::State;
use super::tree::Node;
use crate::scene::text::{Fault, quote_bytes};
use glam::{DAffine3, DMat4, DQuat, DVec3};

/// Units of length in metres.
const UNITS: &[(&str, f64)] = &[
    ("METERS", 1.0),
    ("CENTIMETERS", 1e-2),
    ("MILLIMETERS", 1e-3),
    ("MICROMETERS", 1e-6),
    ("MICRONS", 1e-6),
    ("NANOMETERS", 1e-9),
    ("ANGSTROMS", 1e-10),
    ("KILOMETERS", 1e3),
    ("FEET", 0.3048),
    ("INCHES", 0.0254),
    ("POINTS", 0.0254 / 72.0),
    ("YARDS", 0.9144),
    ("MILES", 1609.344),
    ("NAUTICAL_MILES", 1852.0),
];

/// The affine transform of a matrix, or `None` if the matrix is a projection.
pub fn affine(numbers: &[f64; 16]) -> Option<DAffine3> {
    // The rows of the file's matrix are the columns of this one.
    let matrix = DMat4::from_cols_array(numbers);
    (matrix.row(3).to_array() == [0.0, 0.0, 0.0, 1.0]).then(|| DAffine3::from_mat4(matrix))
}

/// The problem of a matrix that is not affine.
pub const PROJECTION: &str = "matrix: the fourth column is not 0 0 0 1";

impl State<'_> {
    /// Applies a transform node.
    pub fn apply_transform(&mut self, node: &Node) -> Result<(), Fault> {
        let local = match node.kind {
            NodeType::Translation => DAffine3::from_translation(node.vector("translation", DVec3::ZERO)?),
            NodeType::Rotation => DAffine3::from_quat(node.rotation("rotation")?),
            // A field that is ignored (`~`) makes the node have no effect, where its default would have one.
            NodeType::ResetTransform if node.ignores("whatToReset") => return Ok(()),
            NodeType::Units if node.ignores("units") => return Ok(()),
            NodeType::RotationXyz if node.ignores("axis") => return Ok(()),
            NodeType::RotationXyz => {
                let angle = node.number("angle", 0.0)?;
                DAffine3::from_quat(match node.word("axis")? {
                    None | Some(b"X") => DQuat::from_rotation_x(angle),
                    Some(b"Y") => DQuat::from_rotation_y(angle),
                    Some(b"Z") => DQuat::from_rotation_z(angle),
                    Some(other) => {
                        let problem = format!("axis: {} is not an axis", quote_bytes(other));
                        return Err(Fault::new(None, problem, "give X, Y or Z"));
                    }
                })
            }
            NodeType::Scale => DAffine3::from_scale(node.vector("scaleFactor", DVec3::ONE)?),
            NodeType::Transform => transform(node)?,
            NodeType::MatrixTransform => {
                let matrix = node.array("matrix", DMat4::IDENTITY.to_cols_array())?;
                affine(&matrix).ok_or_else(|| Fault::new(None, PROJECTION, "projections cannot be traced"))?
            }
            NodeType::ResetTransform => {
                if node.word("whatToReset")? != Some(b"BBOX") {
                    self.transform = DAffine3::IDENTITY;
                    self.unit = 1.0;
                }
                return Ok(());
            }
            _ => {
                let word = node.word("units")?.unwrap_or(b"METERS");
                let Some((_, unit)) = UNITS.iter().find(|(name, _)| name.as_bytes() == word) else {
                    let known: Vec<&str> = UNITS.iter().map(|(name, _)| *name).collect();
                    let problem = format!("units: {} is not a unit", quote_bytes(word));
                    return Err(Fault::new(None, problem, format!("give one of {}", known.join(", "))));
                };
                let scale = unit / self.unit;
                self.unit = *unit;
                DAffine3::from_scale(DVec3::splat(scale))
            }
        };
        self.transform *= local;
        Ok(())
    }
}

/// The transform of a `Transform` node: it scales along rotated axes and rotates, both around a centre, then
/// translates.
fn transform(node: &Node) -> Result<DAffine3, Fault> {
    let center = node.vector("center", DVec3::ZERO)?;
    let axes = node.rotation("scaleOrientation")?;
    let scale = node.vector("scaleFactor", DVec3::ONE)?;
    let place = DAffine3::from_translation(node.vector("translation", DVec3::ZERO)? + center);
    let turn = DAffine3::from_quat(node.rotation("rotation")? * axes);
    let back = DAffine3::from_quat(axes.inverse()) * DAffine3::from_translation(-center);
    Ok(place * turn * DAffine3::from_scale(scale) * back)
}
