//! Reads the primitives, which are converted to triangles.

use super::{AffReader, loose};
use crate::scene::mesh_builder::has_direction;
use crate::scene::text::{Fault, Tokenizer, quote_bytes};
use glam::DVec3;

/// The index of the normal of a corner without one.
const NO_NORMAL: u32 = u32::MAX;

/// A position and a normal.
type Corner = (DVec3, DVec3);

impl AffReader {
    /// Skips the parameters of a primitive.
    pub(super) fn skip_primitive(&mut self, entity: &[u8], tokens: &mut Tokenizer) -> Result<(), Fault> {
        let count = match entity {
            b"s" => 4,
            b"c" => 8,
            b"tt" => 1 + 15,
            b"ttp" => 1 + 24,
            b"p" => tokens.count(6, "p")? * 3,
            b"pp" => tokens.count(12, "pp")? * 6,
            b"tpa" => tokens.count(38, "tpa")? * 19,
            b"m" => return self.mesh(tokens, false),
            other => {
                let problem = format!("{} is not an entity of BART or NFF files", quote_bytes(other));
                return Err(tokens.fault(problem, "repair or remove it"));
            }
        };
        tokens.skip(count, "a primitive")
    }

    /// Reads the parameters of a primitive and adds it to the mesh. Returns false if a corner's normal is not finite.
    pub(super) fn primitive(&mut self, entity: &[u8], tokens: &mut Tokenizer) -> Result<bool, Fault> {
        if !self.building() {
            return self.skip_primitive(entity, tokens).map(|()| true);
        }
        let is_finite = |normals: &[DVec3]| normals.iter().all(|normal| normal.is_finite());
        let mut finite = true;
        match entity {
            b"s" => {
                let [x, y, z, radius] = tokens.any_numbers("s")?;
                self.mesh.sphere(DVec3::new(x, y, z), radius, self.segments)
            }
            b"c" => {
                let [a, b, c, base, x, y, z, apex] = tokens.any_numbers("c")?;
                match self.cones {
                    true => self.mesh.cone((DVec3::new(a, b, c), base), (DVec3::new(x, y, z), apex), self.segments),
                    false => Ok(()),
                }
            }
            b"p" => {
                let count = tokens.count(6, "p")?;
                let corners: Vec<DVec3> = read(count, || vector(tokens, "p"))?;
                self.polygon(&corners, &[])
            }
            b"pp" => {
                let count = tokens.count(12, "pp")?;
                let (corners, normals) =
                    read(count, || corner(tokens, "pp"))?.into_iter().unzip::<_, _, Vec<_>, Vec<_>>();
                finite = is_finite(&normals);
                self.polygon(&corners, &normals)
            }
            b"tt" | b"ttp" => {
                tokens.need("a texture")?;
                self.texture();
                let (mut corners, mut normals) = (Vec::new(), Vec::new());
                for _ in 0..3 {
                    corners.push(vector(tokens, "tt")?);
                    if entity == b"ttp" {
                        normals.push(loose::normal(tokens, "ttp")?);
                    }
                    tokens.skip(2, "tt")?;
                }
                finite = is_finite(&normals);
                self.polygon(&corners, &normals)
            }
            b"tpa" => self.animated_triangle(tokens),
            b"m" => self.mesh(tokens, true),
            _ => self.skip_primitive(entity, tokens),
        }
        .map(|()| finite)
    }

    /// Adds a polygon that shares no vertices with others.
    fn polygon(&mut self, corners: &[DVec3], normals: &[DVec3]) -> Result<(), Fault> {
        self.mesh.new_shape();
        self.mesh.polygon(corners, normals)
    }

    /// Reads `tpa`: a triangle with corners and normals at several times, which are interpolated linearly.
    fn animated_triangle(&mut self, tokens: &mut Tokenizer) -> Result<(), Fault> {
        let count = tokens.count(38, "tpa")?;
        let mut before: Option<(f64, [Corner; 3])> = None;
        let mut found: Option<[Corner; 3]> = None;
        for _ in 0..count {
            let time = tokens.number("tpa")?;
            let mut now = [(DVec3::ZERO, DVec3::ZERO); 3];
            for corner_now in &mut now {
                *corner_now = corner(tokens, "tpa")?;
            }
            match (&before, &found) {
                (Some((earlier, _)), _) if time < *earlier => {
                    let problem = format!("tpa: time {time} follows the later time {earlier}");
                    return Err(tokens.fault(problem, "put the triangle's times in order"));
                }
                (_, Some(_)) => {}
                (None, _) if self.time <= time => found = Some(now),
                (Some((earlier, then)), _) if self.time <= time => {
                    // `earlier` is less than `self.time`, which is at most `time`: the divisor is not zero.
                    let share = (self.time - earlier) / (time - earlier);
                    found = Some(
                        [0, 1, 2].map(|i: usize| (then[i].0.lerp(now[i].0, share), then[i].1.lerp(now[i].1, share))),
                    );
                }
                _ => {}
            }
            before = Some((time, now));
        }
        let Some(corners) = found.or(before.map(|(_, last)| last)) else {
            return Err(tokens.fault("tpa: the triangle has no times", "give it at least one time"));
        };
        self.polygon(&corners.map(|c| c.0), &corners.map(|c| c.1))
    }

    /// Reads `m`: an indexed mesh. It is skipped unless `build` is set.
    fn mesh(&mut self, tokens: &mut Tokenizer, build: bool) -> Result<(), Fault> {
        tokens.expect("vertices", "m")?;
        let count = tokens.count(6, "vertices")?;
        let positions = vectors(count, tokens, "vertices", build)?;
        let (mut normals, mut normal_count) = (Vec::new(), None);
        let mut texture_count = None;
        loop {
            match tokens.need("m")? {
                b"normals" => {
                    let count = tokens.count(6, "normals")?;
                    normals = match build {
                        true => read(count, || loose::normal(tokens, "normals"))?,
                        false => tokens.skip(count * 3, "normals").map(|()| Vec::new())?,
                    };
                    normal_count = Some(count);
                }
                b"texturecoords" => {
                    let count = tokens.count(4, "texturecoords")?;
                    tokens.need("a texture")?;
                    self.texture();
                    tokens.skip(count * 2, "texturecoords")?;
                    texture_count = Some(count);
                }
                b"triangles" => break,
                other => {
                    let problem = format!("{} is not a part of a mesh", quote_bytes(other));
                    return Err(tokens.fault(problem, "parts are vertices, normals, texturecoords and triangles"));
                }
            }
        }
        let indices = 3 * (1 + usize::from(normal_count.is_some()) + usize::from(texture_count.is_some()));
        let triangles = tokens.count(2 * indices, "triangles")?;
        if !build {
            return tokens.skip(triangles * indices, "triangles");
        }
        self.mesh.new_shape();
        let mut without_normal = normals.iter().filter(|normal| !has_direction(**normal)).count();
        for _ in 0..triangles {
            let corners = [tokens.index(count, "m")?, tokens.index(count, "m")?, tokens.index(count, "m")?];
            let given = match normal_count {
                None => None,
                Some(count) => {
                    let found = normal_indices(tokens, count)?;
                    without_normal += usize::from(found.is_none());
                    found
                }
            };
            if texture_count.is_some() {
                tokens.skip(3, "m")?;
            }
            if !self.mesh.keep_if(corners.iter().all(|&corner| positions[corner].is_finite())) {
                continue;
            }
            let mut vertices = [0; 3];
            for (corner, vertex) in vertices.iter_mut().enumerate() {
                let at = corners[corner];
                // Without normals in the file, vertices have none, and triangles have flat shading.
                let normal = given.map_or(NO_NORMAL, |given| given[corner] as u32);
                let direction = given.map_or(DVec3::ZERO, |given| normals[given[corner]]);
                *vertex = self.mesh.indexed_vertex([at as u32, normal], positions[at], direction)?;
            }
            self.mesh.triangle(vertices)?;
        }
        if without_normal > 0 {
            self.mesh.warnings.add("mesh with normals that are not finite, zero or missing: the triangles' normals");
        }
        Ok(())
    }
}

fn vector(tokens: &mut Tokenizer, context: &str) -> Result<DVec3, Fault> {
    tokens.any_numbers(context).map(DVec3::from)
}

fn corner(tokens: &mut Tokenizer, context: &str) -> Result<Corner, Fault> {
    Ok((vector(tokens, context)?, loose::normal(tokens, context)?))
}

/// The indices of the normals of a triangle; `None` if one of them is out of range.
fn normal_indices(tokens: &mut Tokenizer, count: usize) -> Result<Option<[usize; 3]>, Fault> {
    let given = [tokens.integer("m")?, tokens.integer("m")?, tokens.integer("m")?];
    let indices = given.map(|index| usize::try_from(index).ok().filter(|&index| index < count));
    Ok(match indices {
        [Some(a), Some(b), Some(c)] => Some([a, b, c]),
        _ => None,
    })
}

/// Reads `count` values; the count has been compared with the size of the file.
fn read<T>(count: usize, one: impl FnMut() -> Result<T, Fault>) -> Result<Vec<T>, Fault> {
    std::iter::repeat_with(one).take(count).collect()
}

/// Reads `count` vectors; skips them unless they are `wanted`.
fn vectors(count: usize, tokens: &mut Tokenizer, context: &str, wanted: bool) -> Result<Vec<DVec3>, Fault> {
    if !wanted {
        return tokens.skip(count * 3, context).map(|()| Vec::new());
    }
    read(count, || vector(tokens, context))
}
