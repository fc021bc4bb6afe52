//! Reads the sequence of entities: contexts, materials, transforms, includes.

use super::colour::{Chromaticity, SAMPLES};
use super::materials::{ColouredAmount, MaterialContext};
use super::transform::{InstanceTransforms, any_number_of, number_of};
use super::{MAX_DEPTH, MgfReader};
use crate::scene::mesh_builder::unit;
use crate::scene::text::{Fault, ReadError, Tokenizer, place, quote_bytes};
use glam::DVec3;
use std::path::Path;

/// Number of bytes that are scanned in the time of a token.
const BYTES_PER_WORD: usize = 16;

/// Replaces `found` by the arguments of an entity.
fn arguments<'a>(tokens: &mut Tokenizer<'a>, found: &mut Vec<&'a [u8]>) {
    found.clear();
    while let Some(word) = tokens.next_on_line() {
        found.push(word);
    }
}

/// Parses exactly `N` numbers with `one`.
fn numbers<const N: usize>(arguments: &[&[u8]], one: fn(&[u8]) -> Result<f64, Fault>) -> Result<[f64; N], Fault> {
    let tokens: [&[u8]; N] = arguments.try_into().map_err(|_| {
        Fault::new(None, format!("there are {} arguments, but {N} numbers are needed", arguments.len()), "")
    })?;
    let mut values = [0.0; N];
    for (value, word) in values.iter_mut().zip(tokens) {
        *value = one(word)?;
    }
    Ok(values)
}

impl MgfReader {
    /// Reads entities until the end of the file, or of the transform that began in line `begun`.
    pub(super) fn block(&mut self, path: &Path, tokens: &mut Tokenizer, begun: Option<usize>) -> Result<(), ReadError> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            let problem = format!("transforms and files are nested more than {MAX_DEPTH} levels deep");
            return Err(Fault::new(None, problem, "flatten the hierarchy").into());
        }
        let mut following = Vec::new();
        while let Some(entity) = tokens.next() {
            let line = tokens.line();
            if entity[0] == b'#' {
                tokens.skip_line();
                continue;
            }
            if entity == b"p"
                && let Some(position) = tokens.plain_numbers_on_line()
            {
                // This fast path covers half of the lines of most files.
                self.count_work(1 + position.len()).map_err(|fault| fault.at(line))?;
                self.vertices.current_mut().position = DVec3::from(position);
                continue;
            }
            arguments(tokens, &mut following);
            self.count_work(1 + following.len()).map_err(|fault| fault.at(line))?;
            match (entity, following.as_slice()) {
                (b"xf", []) => {
                    if begun.is_none() {
                        return Err(Fault::new(Some(line), "`xf` closes no transform", "remove it").into());
                    }
                    self.depth -= 1;
                    return Ok(());
                }
                (b"xf", arguments) => self.transformed(path, tokens, arguments, line)?,
                (b"i", arguments) => self.include(path, arguments).map_err(|error| error.at(line))?,
                (entity, arguments) => {
                    if let Err(fault) = self.entity(entity, arguments) {
                        let problem = format!("{}: {}", String::from_utf8_lossy(entity), fault.problem);
                        if !self.repair(entity, arguments)? {
                            return Err(Fault { problem, ..fault }.at(line).into());
                        }
                        let place = place(path, line);
                        self.mesh.warnings.add(&format!("{place}: {problem}: the default is used"));
                    }
                    self.mesh.not_finite.set_place(|| place(path, line));
                }
            }
        }
        self.depth -= 1;
        match begun {
            None => Ok(()),
            Some(line) => {
                let problem = "the transform that begins here has no closing `xf` in this file";
                Err(Fault::new(Some(line), problem, "the file is truncated or an `xf` is missing").into())
            }
        }
    }

    /// Reads the block of an `xf` once for each of its instances.
    fn transformed(
        &mut self,
        path: &Path,
        tokens: &mut Tokenizer,
        arguments: &[&[u8]],
        line: usize,
    ) -> Result<(), ReadError> {
        let instances = InstanceTransforms::new(arguments).map_err(|fault| fault.at(line))?;
        // The transforms live while the block is read.
        self.mesh.charge(instances.bytes()).map_err(|fault| fault.at(line))?;
        let start = tokens.clone();
        let mut end = None;
        for transform in instances.all() {
            *tokens = start.clone();
            self.count_work(1).map_err(|fault| fault.at(line))?;
            self.mesh.push(transform).map_err(|fault| fault.at(line))?;
            self.emitters.new_group();
            self.block(path, tokens, Some(line))?;
            // Comments, blanks and ignored entities take time as well.
            self.count_work((start.left() - tokens.left()) / BYTES_PER_WORD).map_err(|fault| fault.at(line))?;
            self.mesh.pop();
            self.emitters.new_group();
            end = Some(tokens.clone());
        }
        self.mesh.discharge(instances.bytes());
        if end.is_none() {
            // The array is empty: its block is skipped.
            let mut open = 1;
            while open > 0 {
                match tokens.next() {
                    Some(b"xf") => open = if tokens.peek_on_line().is_some() { open + 1 } else { open - 1 },
                    Some(_) => tokens.skip_line(),
                    None => break,
                }
                tokens.skip_line();
            }
            self.count_work((start.left() - tokens.left()) / BYTES_PER_WORD).map_err(|fault| fault.at(line))?;
        }
        Ok(())
    }

    /// Reads the file of `i FILE [transform]` once for each of its instances.
    fn include(&mut self, path: &Path, arguments: &[&[u8]]) -> Result<(), ReadError> {
        let Some((name, transform)) = arguments.split_first() else {
            return Err(Fault::new(None, "`i` has no file name", "").into());
        };
        let instances = InstanceTransforms::new(transform)?;
        self.mesh.charge(instances.bytes())?;
        for transform in instances.all() {
            let known = self.includes.bytes();
            let (path, bytes) = self.includes.open(path, name)?;
            self.mesh.read(self.includes.bytes() - known);
            self.mesh.push(transform)?;
            self.emitters.new_group();
            self.file(&path, &bytes)?;
            self.mesh.pop();
            self.emitters.new_group();
            self.includes.close();
        }
        self.mesh.discharge(instances.bytes());
        Ok(())
    }

    /// Applies the default of an entity that has an error, if it is not geometry. Returns false if it is.
    ///
    /// # Errors
    /// The names take too much memory.
    #[cold]
    fn repair(&mut self, entity: &[u8], arguments: &[&[u8]]) -> Result<bool, Fault> {
        match (entity, arguments) {
            (b"n", _) => self.vertices.current_mut().normal = glam::Vec3::ZERO,
            (b"c", [name, ..]) => self.colours.select_or(name, Chromaticity::default())?,
            (b"cxy" | b"cspec" | b"cct" | b"cmix", _) => *self.colours.current_mut() = Chromaticity::default(),
            (b"m", [name, ..]) => {
                self.materials.select_or(name, MaterialContext::grey())?;
                self.material_set = false;
            }
            (b"rd" | b"td" | b"ed" | b"rs" | b"ts", _) => {}
            _ => return Ok(false),
        }
        Ok(true)
    }

    fn entity(&mut self, entity: &[u8], arguments: &[&[u8]]) -> Result<(), Fault> {
        match entity {
            b"v" => self.vertices.select(arguments)?,
            b"p" => self.vertices.current_mut().position = DVec3::from(numbers(arguments, any_number_of)?),
            b"n" => self.vertices.current_mut().normal = unit(DVec3::from(numbers(arguments, number_of)?)).as_vec3(),
            b"c" => self.colours.select(arguments)?,
            b"cxy" | b"cspec" | b"cct" | b"cmix" => self.colour(entity, arguments)?,
            b"m" => {
                self.materials.select(arguments)?;
                self.material_set = false;
            }
            b"rd" | b"td" | b"ed" | b"rs" | b"ts" => self.material(entity, arguments)?,
            b"sides" | b"ir" => {}
            b"o" => {
                self.mesh.new_shape();
                self.emitters.new_group();
            }
            b"ies" => self.mesh.warnings.add("`ies`: luminaire data ignored"),
            b"f" | b"fh" | b"sph" | b"cyl" | b"cone" | b"prism" | b"ring" | b"torus" => {
                self.shape(entity, arguments)?
            }
            other => self.mesh.warnings.add(&format!("unknown entity {} ignored", quote_bytes(other))),
        }
        Ok(())
    }

    fn colour(&mut self, entity: &[u8], arguments: &[&[u8]]) -> Result<(), Fault> {
        if matches!(entity, b"cspec" | b"cct") {
            self.count_work(SAMPLES)?;
        }
        let found = match entity {
            b"cxy" => {
                let [x, y] = numbers(arguments, number_of)?;
                Chromaticity::new(x, y)
            }
            b"cct" => {
                let [kelvin] = numbers(arguments, number_of)?;
                Chromaticity::black_body(kelvin)
            }
            b"cspec" => {
                let values = arguments.iter().map(|word| number_of(word)).collect::<Result<Vec<f64>, Fault>>()?;
                match values.as_slice() {
                    [from, to, values @ ..] => Chromaticity::spectrum(*from, *to, values),
                    _ => None,
                }
            }
            _ => {
                let pair = |pair: &[&[u8]]| match *pair {
                    [weight, name] => Ok((number_of(weight)?, *self.colours.find(name)?)),
                    _ => Err(Fault::new(None, "a weight without a colour", "")),
                };
                Chromaticity::mix(&arguments.chunks(2).map(pair).collect::<Result<Vec<_>, Fault>>()?)
            }
        };
        let none = || Fault::new(None, "the colour is not valid", "values must not be negative or all zero");
        *self.colours.current_mut() = found.ok_or_else(none)?;
        Ok(())
    }

    fn material(&mut self, entity: &[u8], arguments: &[&[u8]]) -> Result<(), Fault> {
        let (amount, roughness) = match entity {
            b"rs" | b"ts" => numbers(arguments, number_of).map(|[amount, roughness]| (amount, roughness))?,
            _ => numbers(arguments, number_of).map(|[amount]| (amount, 0.0))?,
        };
        if amount < 0.0 || roughness < 0.0 {
            return Err(Fault::new(None, "the amount of light or the roughness is negative", "give 0 or more"));
        }
        let amount = ColouredAmount { amount, colour: *self.colours.current() };
        let material = self.materials.current_mut();
        match entity {
            b"rd" => material.diffuse = amount,
            b"td" => material.translucent = amount,
            b"ed" => material.emitted = amount,
            b"rs" => (material.specular, material.roughness) = (amount, roughness),
            _ => material.transparent = amount,
        }
        self.material_set = false;
        Ok(())
    }
}
