//! Entities one after another: everything but the primitives.

use super::camera::{Animation, Viewpoint};
use super::keys::{Keyframes, rotation};
use super::{Pass, Reader};
use crate::scene::Material;
use crate::scene::text::{Fault, Trouble, Words, quote_bytes};
use glam::{DAffine3, DVec3};
use std::path::Path;

/// A transform whose `}` is to come.
struct Open {
    line: usize,
    /// False if there is nothing to pop: the mesh does not follow in the first pass.
    pushed: bool,
    hides: bool,
}

impl Reader {
    /// Goes through all entities of a file.
    pub(super) fn entities(&mut self, path: &Path, words: &mut Words) -> Result<(), Trouble> {
        let mut open: Vec<Open> = Vec::new();
        while let Some(entity) = words.next() {
            match entity {
                b"i" => self.include(path, words)?,
                b"xs" | b"x" => {
                    let line = words.line();
                    let (transform, visible) = self.transform(entity, words)?;
                    words.expect("{", "a transform")?;
                    let pushed = self.pass == Pass::Mesh;
                    if pushed {
                        self.mesh.push(transform)?;
                    }
                    self.hidden += usize::from(!visible);
                    open.push(Open { line, pushed, hides: !visible });
                }
                b"}" => {
                    let Some(ended) = open.pop() else {
                        return Err(words.fault("`}` ends no transform", "remove it, or open one before").into());
                    };
                    self.hidden -= usize::from(ended.hides);
                    if ended.pushed {
                        self.mesh.pop();
                    }
                }
                _ => self.entity(entity, words)?,
            }
        }
        match open.last() {
            None => Ok(()),
            Some(open) => {
                let problem = "the transform that begins here has no `}` in this file";
                Err(Fault::new(Some(open.line), problem, "the file is truncated or a brace is missing").into())
            }
        }
    }

    fn include(&mut self, path: &Path, words: &mut Words) -> Result<(), Trouble> {
        let level = words.integer("i")?;
        let name = words.need("i")?;
        if level > self.detail {
            return Ok(());
        }
        let (path, bytes) = self.includes.open(path, name)?;
        self.file(&path, &bytes)?;
        self.includes.close();
        Ok(())
    }

    /// What follows `xs` or `x`: the transform, and whether what is inside is visible.
    fn transform(&mut self, entity: &[u8], words: &mut Words) -> Result<(DAffine3, bool), Fault> {
        if entity == b"x" {
            let name = words.need("x")?;
            if self.pass == Pass::Keys {
                return Ok((DAffine3::IDENTITY, true));
            }
            return Ok(self.moved(name));
        }
        let scale = words.numbers("xs").map(DVec3::from)?;
        let turn = rotation(words, "xs")?;
        let translation = words.numbers("xs").map(DVec3::from)?;
        Ok((DAffine3::from_scale_rotation_translation(scale, turn, translation), true))
    }

    /// Where keyframes put things, and whether those are visible. BART's robots name keyframes that are nowhere: what
    /// they would move stays where it is.
    fn moved(&mut self, name: &[u8]) -> (DAffine3, bool) {
        match self.keys.get(name) {
            Some(keys) => (keys.transform(self.time), keys.visible(self.time)),
            None => {
                let name = quote_bytes(name);
                self.mesh.warnings.add(&format!("there are no keyframes {name}: what they would move stays"));
                (DAffine3::IDENTITY, true)
            }
        }
    }

    fn entity(&mut self, entity: &[u8], words: &mut Words) -> Result<(), Fault> {
        let keys = self.pass == Pass::Keys;
        match entity {
            b"v" => self.view = Some(Viewpoint::read(words)?),
            b"b" => self.background = words.numbers("b").map(DVec3::from)?.as_vec3().max(glam::Vec3::ZERO),
            b"am" => self.ambient = words.numbers("am").map(DVec3::from)?,
            b"a" => self.animation = Some(Animation::read(words)?),
            b"d" => self.detail = words.integer("d")?,
            b"k" => {
                let name = words.need("k")?;
                let keyframes = Keyframes::read(words)?;
                if keys && keyframes.left_out > 0 {
                    let (name, count) = (quote_bytes(name), keyframes.left_out);
                    self.mesh.warnings.add(&format!("keyframes {name}: {count} keys out of order left out"));
                }
                if keys && self.keys.insert(name.to_vec(), keyframes).is_some() {
                    let name = quote_bytes(name);
                    self.mesh.warnings.add(&format!("keyframes {name} are given again: the last ones count"));
                }
            }
            b"l" | b"la" => self.light(entity == b"la", words)?,
            b"f" => self.plain_material(words)?,
            b"fm" => self.material(words)?,
            _ if keys => self.skip_primitive(entity, words)?,
            _ => self.primitive(entity, words)?,
        }
        Ok(())
    }

    /// `l`, or `la`, which keyframes move.
    fn light(&mut self, animated: bool, words: &mut Words) -> Result<(), Fault> {
        let name = if animated { Some(words.need("la")?) } else { None };
        let position = words.numbers("l").map(DVec3::from)?;
        let coloured = words.peek_on_line().is_some_and(|word| word[0].is_ascii_digit() || b"+-.".contains(&word[0]));
        let colour = if coloured { words.numbers("l").map(DVec3::from)? } else { DVec3::ONE };
        if !self.building() {
            return Ok(());
        }
        let (position, visible) = match name {
            None => (position, true),
            Some(name) => {
                let (transform, visible) = self.moved(name);
                (transform.transform_point3(position), visible)
            }
        };
        if visible { self.mesh.light(position, colour) } else { Ok(()) }
    }

    /// `f`: colour, Kd, Ks, exponent, transparency, index of refraction; a texture's name may follow in the line.
    fn plain_material(&mut self, words: &mut Words) -> Result<(), Fault> {
        let [r, g, b, diffuse, specular, exponent, transparency, _index] = words.numbers("f")?;
        if words.peek_on_line().is_some_and(|word| word.contains(&b'.')) {
            words.skip(1, "f")?;
            self.texture();
        }
        let diffuse = (DVec3::new(r, g, b) * diffuse).as_vec3();
        let ambient = diffuse * 0.1 * self.ambient.as_vec3();
        let specular = glam::Vec3::splat(specular as f32);
        let material = Material { ambient, diffuse, ..Material::neutral() };
        self.set_material(material.shiny(specular, exponent as f32, specular.x.clamp(0.0, 1.0)), transparency);
        Ok(())
    }

    /// `fm`: ambient, diffuse, specular colour, exponent, transparency, index of refraction.
    fn material(&mut self, words: &mut Words) -> Result<(), Fault> {
        let ambient = words.numbers("fm").map(DVec3::from)? * self.ambient;
        let diffuse = words.numbers("fm").map(DVec3::from)?;
        let specular = words.numbers("fm").map(DVec3::from)?;
        let [exponent, transparency, _index] = words.numbers("fm")?;
        let luminance = specular.dot(LUMINANCE).clamp(0.0, 1.0) as f32;
        let material = Material { ambient: ambient.as_vec3(), diffuse: diffuse.as_vec3(), ..Material::neutral() };
        self.set_material(material.shiny(specular.as_vec3(), exponent as f32, luminance), transparency);
        Ok(())
    }

    fn set_material(&mut self, material: Material, transparency: f64) {
        if self.pass == Pass::Mesh {
            if transparency > 0.0 {
                self.mesh.warnings.add("transparent material: shown opaque");
            }
            self.mesh.set_material(material);
        }
    }

    /// Says that a texture is passed over.
    pub(super) fn texture(&mut self) {
        if self.pass == Pass::Mesh {
            self.mesh.warnings.add("texture passed over");
        }
    }
}

/// Weights of linear red, green and blue in luminance (Rec. 709).
const LUMINANCE: DVec3 = DVec3::new(0.2126, 0.7152, 0.0722);
