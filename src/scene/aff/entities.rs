//! Reads the sequence of entities of a file, and all entities except the primitives.

use super::camera::{Animation, Viewpoint};
use super::keys::{Keyframes, rotation};
use super::{AffReader, Pass, loose};
use crate::scene::Material;
use crate::scene::text::{Fault, ReadError, Tokenizer, odd, place, quote_bytes};
use glam::{DAffine3, DVec3};
use std::path::Path;

/// A transform block that has not been closed yet.
struct OpenTransform {
    line: usize,
    /// True if the transform was pushed onto the mesh builder's stack, as in the second pass.
    pushed: bool,
    /// True if the block is invisible.
    hides: bool,
}

impl AffReader {
    /// Reads all entities of a file.
    pub(super) fn entities(&mut self, path: &Path, tokens: &mut Tokenizer) -> Result<(), ReadError> {
        let mut open: Vec<OpenTransform> = Vec::new();
        while let Some(entity) = tokens.next() {
            match entity {
                b"i" => self.include(path, tokens)?,
                b"xs" | b"x" => {
                    let line = tokens.line();
                    let (transform, visible) = self.transform(entity, tokens)?;
                    tokens.expect("{", "a transform")?;
                    let pushed = self.pass == Pass::Mesh;
                    if pushed {
                        self.mesh.push(transform)?;
                    }
                    self.hidden += usize::from(!visible);
                    open.push(OpenTransform { line, pushed, hides: !visible });
                }
                b"}" => {
                    let Some(ended) = open.pop() else {
                        return Err(tokens
                            .fault("`}` closes no transform", "remove it, or open a transform before it")
                            .into());
                    };
                    self.hidden -= usize::from(ended.hides);
                    if ended.pushed {
                        self.mesh.pop();
                    }
                }
                _ => {
                    self.entity(entity, path, tokens)?;
                    self.mesh.not_finite.set_place(|| place(path, tokens.line()));
                }
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

    fn include(&mut self, path: &Path, tokens: &mut Tokenizer) -> Result<(), ReadError> {
        let level = tokens.integer("i")?;
        let name = tokens.need("i")?;
        if level > self.detail {
            return Ok(());
        }
        let (path, bytes) = self.includes.open(path, name)?;
        self.file(&path, &bytes)?;
        self.includes.close();
        Ok(())
    }

    /// Reads the parameters of `xs` or `x`: the transform, and whether the content of the block is visible.
    fn transform(&mut self, entity: &[u8], tokens: &mut Tokenizer) -> Result<(DAffine3, bool), Fault> {
        if entity == b"x" {
            let name = tokens.need("x")?;
            if self.pass == Pass::Keys {
                return Ok((DAffine3::IDENTITY, true));
            }
            return Ok(self.animated(name));
        }
        let scale = tokens.numbers("xs").map(DVec3::from)?;
        let turn = rotation(tokens, "xs")?;
        let translation = tokens.numbers("xs").map(DVec3::from)?;
        Ok((DAffine3::from_scale_rotation_translation(scale, turn, translation), true))
    }

    /// The transform of the named keyframes, and whether they make objects visible. If they do not exist, the transform
    /// is the identity: BART's scene `robots` names keyframes that it does not define.
    fn animated(&mut self, name: &[u8]) -> (DAffine3, bool) {
        match self.keys.get(name) {
            Some(keys) => (keys.transform(self.time), keys.visible(self.time)),
            None => {
                let name = quote_bytes(name);
                self.mesh.warnings.add(&format!("there are no keyframes {name}: what refers to them is not animated"));
                (DAffine3::IDENTITY, true)
            }
        }
    }

    /// Warns in the second pass that numbers of an entity are not finite.
    #[cold]
    fn warn(&mut self, path: &Path, tokens: &Tokenizer, text: &str) {
        if self.pass == Pass::Mesh {
            self.mesh.warnings.add(&format!("{}: {text}", place(path, tokens.line())));
        }
    }

    /// Reads the colour of an entity that is nothing else. One that is not three finite numbers is a warning, and
    /// replaced by `default`.
    fn colour(&mut self, entity: &str, default: DVec3, path: &Path, tokens: &mut Tokenizer) -> Result<DVec3, Fault> {
        let (numbers, given) = loose::numbers::<3>(tokens, entity)?;
        let colour = DVec3::from(numbers);
        if given < 3 {
            self.warn(path, tokens, &format!("{entity}: {given} numbers instead of 3: the default is used"));
        } else if !colour.as_vec3().is_finite() {
            self.warn(path, tokens, &format!("{entity}: the colour is not finite: the default is used"));
        }
        self.surplus(entity, given == 3, path, tokens)?;
        Ok(if given == 3 && colour.as_vec3().is_finite() { colour } else { default })
    }

    /// Skips what follows the numbers of an entity in its line. This is a warning if the entity was `complete`;
    /// otherwise there is one already.
    fn surplus(&mut self, entity: &str, complete: bool, path: &Path, tokens: &mut Tokenizer) -> Result<(), Fault> {
        if let Some(word) = loose::skip_words(tokens)?.filter(|_| complete) {
            let word = quote_bytes(word);
            self.warn(path, tokens, &format!("{entity}: {word} and what follows in the line is ignored"));
        }
        Ok(())
    }

    fn entity(&mut self, entity: &[u8], path: &Path, tokens: &mut Tokenizer) -> Result<(), Fault> {
        let keys = self.pass == Pass::Keys;
        match entity {
            b"v" => {
                let line = tokens.line();
                self.view_place = place(path, line);
                self.view = match Viewpoint::read(tokens)? {
                    Ok(view) => Some(view),
                    Err(fault) => {
                        let place = place(path, fault.line.unwrap_or(line));
                        if !keys {
                            self.mesh.warnings.add(&format!("{place}: {}: the viewpoint is ignored", fault.problem));
                        }
                        None
                    }
                }
            }
            b"b" => self.background = self.colour("b", DVec3::ZERO, path, tokens)?.as_vec3().max(glam::Vec3::ZERO),
            b"am" => self.ambient = self.colour("am", DVec3::ONE, path, tokens)?,
            b"a" => self.animation = Some(Animation::read(tokens)?),
            b"d" => self.detail = tokens.integer("d")?,
            b"k" => {
                let name = tokens.need("k")?;
                let keyframes = Keyframes::read(tokens)?;
                if keys && keyframes.ignored > 0 {
                    let (name, count) = (quote_bytes(name), keyframes.ignored);
                    self.mesh.warnings.add(&format!("keyframes {name}: {count} keys out of order are ignored"));
                }
                if keys && self.keys.insert(name.to_vec(), keyframes).is_some() {
                    let name = quote_bytes(name);
                    self.mesh
                        .warnings
                        .add(&format!("keyframes {name} are defined more than once: the last definition is used"));
                }
            }
            b"l" | b"la" => self.light(entity == b"la", path, tokens)?,
            b"f" => self.plain_material(path, tokens)?,
            b"fm" => self.material(path, tokens)?,
            _ if keys => self.skip_primitive(entity, tokens)?,
            _ => {
                let normals = self.primitive(entity, tokens)?;
                if !normals {
                    self.warn(path, tokens, "a normal is not three finite numbers: such normals are computed");
                }
            }
        }
        Ok(())
    }

    /// Reads the parameters of `l`, or of `la`, which keyframes animate.
    fn light(&mut self, animated: bool, path: &Path, tokens: &mut Tokenizer) -> Result<(), Fault> {
        let name = if animated { Some(tokens.need("la")?) } else { None };
        let (position, given) = loose::numbers::<3>(tokens, "l")?;
        let position = DVec3::from(position);
        let coloured = given == 3 && tokens.peek_on_line().is_some_and(|word| odd::value(word).is_some());
        let (numbers, channels) = if coloured { loose::numbers::<3>(tokens, "l")? } else { ([1.0; 3], 3) };
        if given < 3 {
            self.warn(path, tokens, &format!("l: {given} numbers instead of 3: the light is ignored"));
        }
        self.surplus("l", given == 3 && channels == 3, path, tokens)?;
        if given < 3 || !self.building() {
            return Ok(());
        }
        let mut colour = DVec3::from(numbers);
        if channels < 3 {
            self.warn(path, tokens, &format!("l: a colour of {channels} numbers instead of 3: the light is white"));
            colour = DVec3::ONE;
        } else if !colour.is_finite() {
            self.warn(path, tokens, "l: the colour is not finite: the default is used");
            colour = DVec3::ONE;
        }
        if !position.is_finite() {
            self.warn(path, tokens, "l: the light's position is not finite: the light is ignored");
            return Ok(());
        }
        let (position, visible) = match name {
            None => (position, true),
            Some(name) => {
                let (transform, visible) = self.animated(name);
                (transform.transform_point3(position), visible)
            }
        };
        if visible && let Some(problem) = self.mesh.light(position, colour)? {
            self.warn(path, tokens, &format!("l: {problem}"));
        }
        Ok(())
    }

    /// Reads the parameters of `f`: colour, Kd, Ks, exponent, transparency, index of refraction, and optionally the
    /// name of a texture on the same line. Some may be missing, with a warning.
    fn plain_material(&mut self, path: &Path, tokens: &mut Tokenizer) -> Result<(), Fault> {
        let (found, given) = loose::numbers::<8>(tokens, "f")?;
        let mut numbers = FILL;
        numbers[..given].copy_from_slice(&found[..given]);
        if given < FILL.len() {
            self.warn(path, tokens, &format!("f: {given} numbers instead of 8: the others have their defaults"));
        }
        if numbers.iter().any(|number| !number.is_finite()) {
            self.warn(path, tokens, "f: a number is not finite: its default is used");
        }
        let grey = given < 3 || numbers[..3].iter().any(|number| !number.is_finite());
        let colour = if grey { GREY } else { DVec3::from_slice(&numbers) };
        let or_default = |i: usize| if numbers[i].is_finite() { numbers[i] } else { FILL[i] };
        let [diffuse, specular, exponent, transparency] = [3, 4, 5, 6].map(or_default);
        let texture = given == FILL.len() && loose::peek(tokens).is_some_and(|word| odd::value(word).is_none());
        if texture {
            tokens.skip(1, "f")?;
            self.texture();
        }
        self.surplus("f", given == FILL.len(), path, tokens)?;
        let diffuse = (colour * diffuse).as_vec3();
        let ambient = diffuse * 0.1 * self.ambient.as_vec3();
        let specular = glam::Vec3::splat(specular as f32);
        let material = Material { ambient, diffuse, ..Material::neutral() };
        self.set_material(material.shiny(specular, exponent as f32, specular.x.clamp(0.0, 1.0)), transparency);
        Ok(())
    }

    /// Reads the parameters of `fm`: ambient, diffuse and specular colour, exponent, transparency, index of refraction.
    fn material(&mut self, path: &Path, tokens: &mut Tokenizer) -> Result<(), Fault> {
        let (numbers, given) = loose::numbers::<12>(tokens, "fm")?;
        if given < numbers.len() {
            self.warn(path, tokens, &format!("fm: {given} numbers instead of 12: the others have their defaults"));
        }
        let is_finite = |range: std::ops::Range<usize>| numbers[range].iter().all(|number| number.is_finite());
        if !is_finite(0..given.min(9)) {
            self.warn(path, tokens, "fm: the colour is not finite: the default is used");
        }
        if !is_finite(given.min(9)..given) {
            self.warn(path, tokens, "fm: a number is not finite: its default is used");
        }
        self.surplus("fm", given == numbers.len(), path, tokens)?;
        let known = |range: std::ops::Range<usize>| given >= range.end && is_finite(range);
        let colour = |at: usize, default| match known(at..at + 3) {
            true => DVec3::from_slice(&numbers[at..]),
            false => default,
        };
        let number = |at: usize| if known(at..at + 1) { numbers[at] } else { FILL[at - 4] };
        let ambient = colour(0, GREY * 0.1) * self.ambient;
        let (diffuse, specular) = (colour(3, GREY), colour(6, DVec3::ZERO));
        let (exponent, transparency) = (number(9), number(10));
        let luminance = specular.dot(LUMINANCE).clamp(0.0, 1.0) as f32;
        let material = Material { ambient: ambient.as_vec3(), diffuse: diffuse.as_vec3(), ..Material::neutral() };
        self.set_material(material.shiny(specular.as_vec3(), exponent as f32, luminance), transparency);
        Ok(())
    }

    fn set_material(&mut self, material: Material, transparency: f64) {
        if self.pass == Pass::Mesh {
            if transparency > 0.0 {
                self.mesh.warnings.add("transparent material: rendered opaque");
            }
            self.mesh.set_material(material);
        }
    }

    /// Adds the warning that textures are ignored.
    pub(super) fn texture(&mut self) {
        if self.pass == Pass::Mesh {
            self.mesh.warnings.add("texture ignored");
        }
    }
}

/// The colour of a material whose colour is not finite.
const GREY: DVec3 = DVec3::splat(0.7);

/// The defaults of `f`: red, green, blue, Kd, Ks, exponent, transparency, index of refraction.
const FILL: [f64; 8] = [GREY.x, GREY.y, GREY.z, 1.0, 0.0, 10.0, 0.0, 1.0];

/// Weights of linear red, green and blue in the luminance (Rec. 709).
const LUMINANCE: DVec3 = DVec3::new(0.2126, 0.7152, 0.0722);
