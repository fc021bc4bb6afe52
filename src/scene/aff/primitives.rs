//! Primitives: what becomes triangles.

use super::Reader;
use crate::scene::text::{Fault, Words, quote_bytes};
use glam::DVec3;

/// A point with a normal.
type Corner = (DVec3, DVec3);

impl Reader {
    /// Passes over a primitive.
    pub(super) fn skip_primitive(&mut self, entity: &[u8], words: &mut Words) -> Result<(), Fault> {
        let count = match entity {
            b"s" => 4,
            b"c" => 8,
            b"tt" => 1 + 15,
            b"ttp" => 1 + 24,
            b"p" => words.count(6, "p")? * 3,
            b"pp" => words.count(12, "pp")? * 6,
            b"tpa" => words.count(38, "tpa")? * 19,
            b"m" => return self.mesh(words, false),
            other => {
                let problem = format!("{} is no entity of a BART or NFF file", quote_bytes(other));
                return Err(words.fault(problem, "repair or remove it"));
            }
        };
        words.skip(count, "a primitive")
    }

    /// Reads a primitive.
    pub(super) fn primitive(&mut self, entity: &[u8], words: &mut Words) -> Result<(), Fault> {
        if !self.building() {
            return self.skip_primitive(entity, words);
        }
        match entity {
            b"s" => {
                let [x, y, z, radius] = words.numbers("s")?;
                self.mesh.sphere(DVec3::new(x, y, z), radius, self.segments)
            }
            b"c" => {
                let [a, b, c, base, x, y, z, apex] = words.numbers("c")?;
                match self.cones {
                    true => self.mesh.cone((DVec3::new(a, b, c), base), (DVec3::new(x, y, z), apex), self.segments),
                    false => Ok(()),
                }
            }
            b"p" => {
                let count = words.count(6, "p")?;
                let corners: Vec<DVec3> = read(count, || vector(words, "p"))?;
                self.polygon(&corners, &[])
            }
            b"pp" => {
                let count = words.count(12, "pp")?;
                let (corners, normals) =
                    read(count, || corner(words, "pp"))?.into_iter().unzip::<_, _, Vec<_>, Vec<_>>();
                self.polygon(&corners, &normals)
            }
            b"tt" | b"ttp" => {
                words.need("a texture")?;
                self.texture();
                let (mut corners, mut normals) = (Vec::new(), Vec::new());
                for _ in 0..3 {
                    corners.push(vector(words, "tt")?);
                    if entity == b"ttp" {
                        normals.push(vector(words, "ttp")?);
                    }
                    words.numbers::<2>("tt")?;
                }
                self.polygon(&corners, &normals)
            }
            b"tpa" => self.animated_triangle(words),
            b"m" => self.mesh(words, true),
            _ => self.skip_primitive(entity, words),
        }
    }

    /// A polygon that shares no vertex with others.
    fn polygon(&mut self, corners: &[DVec3], normals: &[DVec3]) -> Result<(), Fault> {
        self.mesh.new_shape();
        self.mesh.polygon(corners, normals)
    }

    /// `tpa`: a triangle given at several times; between them its corners and normals go straight.
    fn animated_triangle(&mut self, words: &mut Words) -> Result<(), Fault> {
        let count = words.count(38, "tpa")?;
        let mut before: Option<(f64, [Corner; 3])> = None;
        let mut found: Option<[Corner; 3]> = None;
        for _ in 0..count {
            let time = words.number("tpa")?;
            let mut now = [(DVec3::ZERO, DVec3::ZERO); 3];
            for corner_now in &mut now {
                *corner_now = corner(words, "tpa")?;
            }
            match (&before, &found) {
                (Some((earlier, _)), _) if time < *earlier => {
                    let problem = format!("tpa: time {time} comes behind {earlier}");
                    return Err(words.fault(problem, "put the triangle's times in order"));
                }
                (_, Some(_)) => {}
                (None, _) if self.time <= time => found = Some(now),
                (Some((earlier, then)), _) if self.time <= time => {
                    // `earlier` is before the wanted time, which is not behind `time`: they differ
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
            return Err(words.fault("tpa: a triangle at no time at all", "give it one time at least"));
        };
        self.polygon(&corners.map(|c| c.0), &corners.map(|c| c.1))
    }

    /// `m`: an indexed mesh.
    fn mesh(&mut self, words: &mut Words, build: bool) -> Result<(), Fault> {
        words.expect("vertices", "m")?;
        let count = words.count(6, "vertices")?;
        let positions = vectors(count, words, "vertices", build)?;
        let (mut normals, mut normal_count) = (Vec::new(), None);
        let mut texture_count = None;
        loop {
            match words.need("m")? {
                b"normals" => {
                    let count = words.count(6, "normals")?;
                    normals = vectors(count, words, "normals", build)?;
                    normal_count = Some(count);
                }
                b"texturecoords" => {
                    let count = words.count(4, "texturecoords")?;
                    words.need("a texture")?;
                    self.texture();
                    words.skip(count * 2, "texturecoords")?;
                    texture_count = Some(count);
                }
                b"triangles" => break,
                other => {
                    let problem = format!("{} is no part of a mesh", quote_bytes(other));
                    return Err(words.fault(problem, "parts are vertices, normals, texturecoords and triangles"));
                }
            }
        }
        let indices = 3 * (1 + usize::from(normal_count.is_some()) + usize::from(texture_count.is_some()));
        let triangles = words.count(2 * indices, "triangles")?;
        if !build {
            return words.skip(triangles * indices, "triangles");
        }
        self.mesh.new_shape();
        for _ in 0..triangles {
            let mut index = |count| -> Result<[usize; 3], Fault> {
                Ok([words.index(count, "m")?, words.index(count, "m")?, words.index(count, "m")?])
            };
            let corners = index(count)?;
            let given = normal_count.map(&mut index).transpose()?;
            texture_count.map(&mut index).transpose()?;
            let mut vertices = [0; 3];
            for (corner, vertex) in vertices.iter_mut().enumerate() {
                let at = corners[corner];
                // Without normals the vertices have none, and every triangle is shaded with its own
                let normal = given.map_or(0, |given| given[corner]);
                let direction = given.map_or(DVec3::ZERO, |given| normals[given[corner]]);
                *vertex = self.mesh.indexed_vertex([at as u32, normal as u32], positions[at], direction)?;
            }
            self.mesh.triangle(vertices)?;
        }
        Ok(())
    }
}

fn vector(words: &mut Words, what: &str) -> Result<DVec3, Fault> {
    words.numbers(what).map(DVec3::from)
}

fn corner(words: &mut Words, what: &str) -> Result<Corner, Fault> {
    Ok((vector(words, what)?, vector(words, what)?))
}

/// So many of something; the count has been held against the file.
fn read<T>(count: usize, one: impl FnMut() -> Result<T, Fault>) -> Result<Vec<T>, Fault> {
    std::iter::repeat_with(one).take(count).collect()
}

/// So many vectors, or none if they are not wanted.
fn vectors(count: usize, words: &mut Words, what: &str, wanted: bool) -> Result<Vec<DVec3>, Fault> {
    if !wanted {
        return words.skip(count * 3, what).map(|()| Vec::new());
    }
    read(count, || vector(words, what))
}
