//! Fetching a scene of the catalogue from its official source.
//!
//! 1. Download the archive into a file of its own beside the scene's place. What is there of an earlier attempt is
//!    continued (`Range`), and so is a download whose connection breaks or falls silent.
//! 2. Check its SHA-256, where the catalogue knows it, before anything is unpacked.
//! 3. Unpack the one file that is the scene, under a temporary name. Every other entry is only looked at: an archive with
//!    a path that leaves the folder is refused as a whole.
//! 4. Check the file's SHA-256, where the catalogue knows it, before it gets its name. Nothing is ever overwritten.

use crate::error::{Error, Result};
use crate::scene::catalogue::{Archive, Entry, sha256};
use flate2::read::GzDecoder;
use sha2::{Digest, Sha256};
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufReader, BufWriter, Read, Write};
use std::path::{Component, Path, PathBuf};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::time::Duration;

/// Most bytes of an archive, and of everything in it: far more than any scene of the catalogue, and less than a disk.
const MAX_ARCHIVE: u64 = 1 << 30;
const MAX_UNPACKED: u64 = 1 << 33;

/// Attempts in a row that bring nothing, before it is given up.
const MAX_ATTEMPTS: u32 = 3;

/// A server that sends nothing for so long is taken for gone.
pub const SILENCE: Duration = Duration::from_secs(60);

/// What happens, for whoever watches.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Event {
    /// So many bytes are here, of so many if the server says.
    Downloaded(u64, Option<u64>),
    /// The connection broke: it goes on from where it was.
    Again(String),
    /// The archive is here; its file is being unpacked.
    Unpacking,
}

/// How far a fetched file is known to be the right one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verified {
    /// The archive's hash is the catalogue's.
    Archive,
    /// The file's hash is the catalogue's; the archive's is not known.
    File,
    /// The catalogue knows neither. This is the file's SHA-256.
    Unknown(String),
}

/// Fetches a scene into `folder`; returns where it is.
///
/// # Errors
/// [`Error::Input`]: no official source, a file that is there already, what the server says, a wrong hash, a suspicious
/// archive. [`Error::Output`] if it cannot be written.
pub fn fetch(entry: &Entry, folder: &Path, watch: &mut dyn FnMut(Event)) -> Result<(PathBuf, Verified)> {
    let Some(archive) = &entry.fetch else {
        let problem = format!("no official address is known from which {} could be fetched", entry.name);
        return Err(Error::argument(&entry.name, problem, format!("get it by hand, from {}", entry.source)));
    };
    let known = entry.file.iter().find(|candidate| candidate.path == archive.to);
    fetch_archive(&entry.name, archive, known.and_then(|k| k.sha256.as_deref()), folder, SILENCE, watch)
}

/// Fetches one file of an archive; `sha256` is that file's, if it is known; `silence` is how long a server may send nothing.
///
/// # Errors
/// As [`fetch`].
pub fn fetch_archive(
    name: &str,
    archive: &Archive,
    sha256: Option<&str>,
    folder: &Path,
    silence: Duration,
    watch: &mut dyn FnMut(Event),
) -> Result<(PathBuf, Verified)> {
    let target = folder.join(&archive.to);
    if target.exists() {
        return Err(Error::file(&target, None, "it is there already", "nothing is overwritten: remove it first"));
    }
    let home = target.parent().unwrap_or(folder);
    fs::create_dir_all(home).map_err(|e| Error::output(home, e))?;
    let download = home.join(format!(".{name}.tar.gz.part"));
    download_to(&archive.url, &download, silence, watch)?;
    if let Some(expected) = &archive.sha256 {
        let found = hash_file(&download)?;
        if found != *expected {
            discard(&download);
            return Err(wrong_hash(&archive.url, "archive", &found, expected));
        }
    }
    watch(Event::Unpacking);
    let unpacked = home.join(format!(".{name}.unpacked.part"));
    let result = unpack(&download, archive, &unpacked).and_then(|found| match sha256 {
        Some(expected) if found != expected => Err(wrong_hash(&archive.url, "file", &found, expected)),
        // Looked at again: it may have come from elsewhere in the meantime.
        _ if target.exists() => Err(Error::file(&target, None, "it is there already", "nothing is overwritten")),
        _ => fs::rename(&unpacked, &target).map(|()| found).map_err(|e| Error::output(&target, e)),
    });
    // Whether it went well or not: the archive is of no more use, and a broken one must not be continued.
    discard(&download);
    let found = result.inspect_err(|_| discard(&unpacked))?;
    let verified = match (&archive.sha256, sha256) {
        (Some(_), _) => Verified::Archive,
        (None, Some(_)) => Verified::File,
        (None, None) => Verified::Unknown(found),
    };
    Ok((target, verified))
}

/// Removes a temporary file; that it is not there, or cannot be removed, changes nothing.
fn discard(path: &Path) {
    let _ = fs::remove_file(path);
}

fn wrong_hash(url: &str, what: &str, found: &str, expected: &str) -> Error {
    let problem = format!("the {what} is not the expected one: its SHA-256 is {found}, not {expected}");
    Error::argument(url, problem, "it was removed; try again, or get the scene by hand")
}

/// Downloads until all is here, continuing what is there.
fn download_to(url: &str, path: &Path, silence: Duration, watch: &mut dyn FnMut(Event)) -> Result<()> {
    let config = ureq::Agent::config_builder()
        // A redirect must not lead from a protected address to an unprotected one.
        .https_only(url.starts_with("https://"))
        .http_status_as_error(false)
        .timeout_connect(Some(Duration::from_secs(30)))
        .timeout_recv_response(Some(silence))
        .user_agent(concat!("rtbench/", env!("CARGO_PKG_VERSION")))
        .build();
    let agent = ureq::Agent::new_with_config(config);
    let mut failures = 0;
    loop {
        let before = fs::metadata(path).map_or(0, |m| m.len());
        match attempt(&agent, url, path, before, silence, watch)? {
            Attempt::Done => return Ok(()),
            Attempt::Broken(reason) => {
                let progress = fs::metadata(path).map_or(0, |m| m.len()) > before;
                failures = if progress { 0 } else { failures + 1 };
                if failures >= MAX_ATTEMPTS {
                    let hint = "check the connection; the next attempt continues where this one ended";
                    return Err(Error::argument(url, format!("the download breaks off: {reason}"), hint));
                }
                watch(Event::Again(reason));
                std::thread::sleep(Duration::from_millis(200 * u64::from(failures)));
            }
        }
    }
}

enum Attempt {
    Done,
    /// May go better next time.
    Broken(String),
}

/// One request, from byte `have` on.
fn attempt(
    agent: &ureq::Agent,
    url: &str,
    path: &Path,
    have: u64,
    silence: Duration,
    watch: &mut dyn FnMut(Event),
) -> Result<Attempt> {
    let mut request = agent.get(url);
    if have > 0 {
        request = request.header("Range", format!("bytes={have}-"));
    }
    let response = match request.call() {
        Ok(response) => response,
        Err(ureq::Error::Io(e)) => return Ok(Attempt::Broken(one_line(&e))),
        Err(e @ (ureq::Error::Timeout(_) | ureq::Error::ConnectionFailed)) => {
            return Ok(Attempt::Broken(one_line(&e)));
        }
        Err(e) => return Err(Error::argument(url, one_line(&e), "check the connection and the address")),
    };
    let header = |name: &str| response.headers().get(name).and_then(|value| value.to_str().ok());
    let number = |text: &str| text.trim().parse::<u64>().ok();
    let length = header("content-length").and_then(number);
    let (start, total) = match response.status().as_u16() {
        200 => (0, length),
        206 => {
            // bytes FIRST-LAST/TOTAL
            let range = header("content-range").and_then(|text| text.strip_prefix("bytes "));
            let first = range.and_then(|r| r.split('-').next()).and_then(number);
            let total = range.and_then(|r| r.rsplit('/').next()).and_then(number);
            if first != Some(have) {
                discard(path);
                return Ok(Attempt::Broken("the server does not continue where it should".into()));
            }
            (have, total)
        }
        416 => {
            // Nothing behind what is here: it is whole, or not what the server has. The hash will tell, of a fresh one.
            discard(path);
            return Ok(Attempt::Broken("the server has nothing to continue with: it begins again".into()));
        }
        status @ 500..=599 => return Ok(Attempt::Broken(format!("the server answers {status}"))),
        status => {
            let problem = format!("the server answers {status}");
            return Err(Error::argument(url, problem, "the address may have changed: get the scene by hand"));
        }
    };
    if total.is_some_and(|total| total > MAX_ARCHIVE) {
        let problem = format!("the archive has more than {MAX_ARCHIVE} bytes");
        return Err(Error::argument(url, problem, "it cannot be the right one"));
    }
    let output = |e| Error::output(path, e);
    let mut file = OpenOptions::new().create(true).write(true).truncate(false).open(path).map_err(output)?;
    file.set_len(start).map_err(output)?;
    io::Seek::seek(&mut file, io::SeekFrom::Start(start)).map_err(output)?;
    let mut body = response.into_body().into_reader();
    // ureq limits the time of a whole body only. So a thread of its own reads it, and is left behind if nothing comes: it
    // ends when the connection does.
    let (send, pieces) = sync_channel::<io::Result<Vec<u8>>>(16);
    std::thread::spawn(move || {
        let mut buffer = vec![0; 1 << 16];
        loop {
            let piece = match body.read(&mut buffer) {
                Ok(0) => return,
                Ok(read) => Ok(buffer[..read].to_vec()),
                Err(e) if e.kind() == io::ErrorKind::Interrupted => continue,
                Err(e) => Err(e),
            };
            let last = piece.is_err();
            if send.send(piece).is_err() || last {
                return;
            }
        }
    });
    let mut done = start;
    watch(Event::Downloaded(done, total));
    loop {
        let piece = match pieces.recv_timeout(silence) {
            Ok(Ok(piece)) => piece,
            Ok(Err(e)) => return Ok(Attempt::Broken(one_line(&e))),
            Err(RecvTimeoutError::Disconnected) => break,
            Err(RecvTimeoutError::Timeout) => {
                let reason = format!("the server has sent nothing for {} s", silence.as_secs_f64());
                return Ok(Attempt::Broken(reason));
            }
        };
        done += piece.len() as u64;
        if done > MAX_ARCHIVE {
            discard(path);
            let problem = format!("the archive has more than {MAX_ARCHIVE} bytes");
            return Err(Error::argument(url, problem, "it cannot be the right one"));
        }
        file.write_all(&piece).map_err(output)?;
        watch(Event::Downloaded(done, total));
    }
    match total {
        Some(total) if done < total => Ok(Attempt::Broken(format!("{done} of {total} bytes came"))),
        _ => Ok(Attempt::Done),
    }
}

fn one_line(error: &dyn std::fmt::Display) -> String {
    error.to_string().replace('\n', " ")
}

/// Unpacks the archive's one file and returns its SHA-256.
fn unpack(archive: &Path, wanted: &Archive, to: &Path) -> Result<String> {
    let refuse = |problem: String| Error::argument(&wanted.url, problem, "get the scene by hand");
    let broken = |e: io::Error| refuse(format!("the archive is broken: {}", one_line(&e)));
    let file = File::open(archive).map_err(|e| Error::output(archive, e))?;
    let mut archive = tar::Archive::new(GzDecoder::new(BufReader::new(file)).take(MAX_UNPACKED));
    let mut found = None;
    for entry in archive.entries().map_err(broken)? {
        let mut entry = entry.map_err(broken)?;
        let path = entry.path().map_err(broken)?.into_owned();
        let inside = path.components().all(|c| matches!(c, Component::Normal(_) | Component::CurDir));
        if !inside {
            return Err(refuse(format!("the archive wants to write to {:?}, outside of its folder", path)));
        }
        let plain: PathBuf = path.components().filter(|c| matches!(c, Component::Normal(_))).collect();
        if plain == wanted.member && found.is_none() {
            if !entry.header().entry_type().is_file() {
                return Err(refuse(format!("{} in the archive is no plain file", plain.display())));
            }
            let output = File::create(to).map_err(|e| Error::output(to, e))?;
            found = Some(copy_hashed(&mut entry, BufWriter::new(output), broken, |e| Error::output(to, e))?);
        }
    }
    found.ok_or_else(|| refuse(format!("the archive has no {}", wanted.member.display())))
}

/// Copies everything and returns its SHA-256; reading and writing fail with different errors.
fn copy_hashed(
    from: &mut dyn Read,
    mut to: impl Write,
    reading: impl Fn(io::Error) -> Error,
    writing: impl Fn(io::Error) -> Error,
) -> Result<String> {
    let (mut hasher, mut buffer) = (Sha256::new(), vec![0; 1 << 16]);
    loop {
        match from.read(&mut buffer).map_err(&reading)? {
            0 => break,
            read => {
                hasher.update(&buffer[..read]);
                to.write_all(&buffer[..read]).map_err(&writing)?;
            }
        }
    }
    to.flush().map_err(&writing)?;
    Ok(hasher.finalize().iter().map(|byte| format!("{byte:02x}")).collect())
}

fn hash_file(path: &Path) -> Result<String> {
    sha256(path).map_err(|e| Error::file(path, None, format!("cannot be read: {e}"), "try again"))
}
