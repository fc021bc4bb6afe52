//! Entities one after another: contexts, materials, transforms, includes.

use super::colour::{Chromaticity, SAMPLES};
use super::materials::Share;
use super::transform::{Places, number_of};
use super::{MAX_DEPTH, Reader};
use crate::scene::mesh_builder::unit;
use crate::scene::text::{Fault, Trouble, Words, quote_bytes};
use glam::DVec3;
use std::path::Path;

/// Bytes that are gone through in the time of a word.
const BYTES_PER_WORD: usize = 16;

/// The words of an entity that follow its name, in place of those before.
fn arguments<'a>(words: &mut Words<'a>, found: &mut Vec<&'a [u8]>) {
    found.clear();
    while let Some(word) = words.next_on_line() {
        found.push(word);
    }
}

/// So many numbers, and no more.
fn numbers<const N: usize>(arguments: &[&[u8]]) -> Result<[f64; N], Fault> {
    let words: [&[u8]; N] = arguments
        .try_into()
        .map_err(|_| Fault::new(None, format!("{} arguments where {N} numbers are needed", arguments.len()), ""))?;
    let mut values = [0.0; N];
    for (value, word) in values.iter_mut().zip(words) {
        *value = number_of(word)?;
    }
    Ok(values)
}

impl Reader {
    /// Goes through entities up to the end of the file, or of the `xf` that began in line `begun`.
    pub(super) fn block(&mut self, path: &Path, words: &mut Words, begun: Option<usize>) -> Result<(), Trouble> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            let problem = format!("more than {MAX_DEPTH} transforms and files inside each other");
            return Err(Fault::new(None, problem, "flatten the hierarchy").into());
        }
        let mut following = Vec::new();
        while let Some(entity) = words.next() {
            let line = words.line();
            if entity[0] == b'#' {
                words.skip_line();
                continue;
            }
            if entity == b"p"
                && let Some(position) = words.plain_numbers_on_line()
            {
                // Half of what most files consist of
                self.pass(1 + position.len()).map_err(|fault| fault.at(line))?;
                self.vertices.change().position = DVec3::from(position);
                continue;
            }
            arguments(words, &mut following);
            self.pass(1 + following.len()).map_err(|fault| fault.at(line))?;
            match (entity, following.as_slice()) {
                (b"xf", []) => {
                    if begun.is_none() {
                        return Err(Fault::new(Some(line), "`xf` ends no transform", "remove it").into());
                    }
                    self.depth -= 1;
                    return Ok(());
                }
                (b"xf", arguments) => self.transformed(path, words, arguments, line)?,
                (b"i", arguments) => self.include(path, arguments).map_err(|trouble| trouble.at(line))?,
                (entity, arguments) => {
                    self.entity(entity, arguments).map_err(|fault| {
                        let problem = format!("{}: {}", String::from_utf8_lossy(entity), fault.problem);
                        Fault { problem, ..fault }.at(line)
                    })?;
                }
            }
        }
        self.depth -= 1;
        match begun {
            None => Ok(()),
            Some(line) => {
                let problem = "the transform that begins here has no `xf` that ends it in this file";
                Err(Fault::new(Some(line), problem, "the file is truncated or an `xf` is missing").into())
            }
        }
    }

    /// `xf`: goes through its lines once for each place.
    fn transformed(&mut self, path: &Path, words: &mut Words, arguments: &[&[u8]], line: usize) -> Result<(), Trouble> {
        let places = Places::new(arguments).map_err(|fault| fault.at(line))?;
        // They stay while others are made inside
        self.mesh.charge(places.bytes()).map_err(|fault| fault.at(line))?;
        let start = words.clone();
        let mut end = None;
        for place in places.all() {
            *words = start.clone();
            self.pass(1).map_err(|fault| fault.at(line))?;
            self.mesh.push(place).map_err(|fault| fault.at(line))?;
            self.emitters.new_group();
            self.block(path, words, Some(line))?;
            // Comments, blanks and what is passed over take time as well
            self.pass((start.left() - words.left()) / BYTES_PER_WORD).map_err(|fault| fault.at(line))?;
            self.mesh.pop();
            self.emitters.new_group();
            end = Some(words.clone());
        }
        self.mesh.discharge(places.bytes());
        if end.is_none() {
            // An array of nothing: its lines are passed over
            let mut open = 1;
            while open > 0 {
                match words.next() {
                    Some(b"xf") => open = if words.peek_on_line().is_some() { open + 1 } else { open - 1 },
                    Some(_) => words.skip_line(),
                    None => break,
                }
                words.skip_line();
            }
            self.pass((start.left() - words.left()) / BYTES_PER_WORD).map_err(|fault| fault.at(line))?;
        }
        Ok(())
    }

    /// `i FILE [transform]`.
    fn include(&mut self, path: &Path, arguments: &[&[u8]]) -> Result<(), Trouble> {
        let Some((name, transform)) = arguments.split_first() else {
            return Err(Fault::new(None, "`i` names no file", "").into());
        };
        let places = Places::new(transform)?;
        self.mesh.charge(places.bytes())?;
        for place in places.all() {
            let known = self.includes.bytes();
            let (path, bytes) = self.includes.open(path, name)?;
            self.mesh.read(self.includes.bytes() - known);
            self.mesh.push(place)?;
            self.emitters.new_group();
            self.file(&path, &bytes)?;
            self.mesh.pop();
            self.emitters.new_group();
            self.includes.close();
        }
        self.mesh.discharge(places.bytes());
        Ok(())
    }

    fn entity(&mut self, entity: &[u8], arguments: &[&[u8]]) -> Result<(), Fault> {
        match entity {
            b"v" => self.vertices.select(arguments)?,
            b"p" => self.vertices.change().position = DVec3::from(numbers(arguments)?),
            b"n" => self.vertices.change().normal = unit(DVec3::from(numbers(arguments)?)).as_vec3(),
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
            b"ies" => self.mesh.warnings.add("`ies`: luminaire data passed over"),
            b"f" | b"fh" | b"sph" | b"cyl" | b"cone" | b"prism" | b"ring" | b"torus" => {
                self.shape(entity, arguments)?
            }
            other => self.mesh.warnings.add(&format!("unknown entity {} passed over", quote_bytes(other))),
        }
        Ok(())
    }

    fn colour(&mut self, entity: &[u8], arguments: &[&[u8]]) -> Result<(), Fault> {
        if matches!(entity, b"cspec" | b"cct") {
            self.pass(SAMPLES)?;
        }
        let found = match entity {
            b"cxy" => {
                let [x, y] = numbers(arguments)?;
                Chromaticity::new(x, y)
            }
            b"cct" => {
                let [kelvin] = numbers(arguments)?;
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
        let none = || Fault::new(None, "there is no such colour", "is something negative, or all of it zero?");
        *self.colours.change() = found.ok_or_else(none)?;
        Ok(())
    }

    fn material(&mut self, entity: &[u8], arguments: &[&[u8]]) -> Result<(), Fault> {
        let (amount, roughness) = match entity {
            b"rs" | b"ts" => numbers(arguments).map(|[amount, roughness]| (amount, roughness))?,
            _ => numbers(arguments).map(|[amount]| (amount, 0.0))?,
        };
        if amount < 0.0 || roughness < 0.0 {
            return Err(Fault::new(None, "a negative amount of light", "give 0 or more"));
        }
        let share = Share { amount, colour: *self.colours.current() };
        let material = self.materials.change();
        match entity {
            b"rd" => material.diffuse = share,
            b"td" => material.through = share,
            b"ed" => material.emitted = share,
            b"rs" => (material.specular, material.roughness) = (share, roughness),
            _ => material.transparent = share,
        }
        self.material_set = false;
        Ok(())
    }
}
