//! Downloads a scene of the catalogue from its official source.
//!
//! 1. Download the archive into a temporary file in the scene's folder. A partial file of an earlier attempt is
//!    continued (`Range`), and so is a download of which the connection breaks or stalls.
//! 2. Check the archive's SHA-256, if the catalogue has one, before anything is unpacked.
//! 3. Unpack the scene's file under a temporary name. No other entry is unpacked, but all paths are checked: an archive
//!    with a path that leaves the folder is refused as a whole.
//! 4. Check the file's SHA-256, if the catalogue has one, before the file is renamed. No file is ever overwritten.

use crate::error::{Error, Result, one_line};
use crate::scene::catalogue::{Archive, Entry, sha256};
use flate2::read::GzDecoder;
use sha2::{Digest, Sha256};
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufReader, BufWriter, Read, Write};
use std::path::{Component, Path, PathBuf};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::time::Duration;

/// The largest archive in bytes: far more than any scene of the catalogue needs.
const MAX_ARCHIVE: u64 = 1 << 30;
/// The largest number of bytes that are decompressed from an archive.
const MAX_UNPACKED: u64 = 1 << 33;

/// The download fails after this many consecutive attempts that receive no byte.
const MAX_ATTEMPTS: u32 = 3;

/// A connection that delivers no byte for this long counts as broken.
const READ_TIMEOUT: Duration = Duration::from_secs(60);

/// Progress of a download, for the callback of [`fetch_archive`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Event {
    /// Bytes received so far, and the size of the archive if the server sends it.
    Downloaded(u64, Option<u64>),
    /// The connection broke for this reason; the download continues where it ended.
    Retry(String),
    /// The archive is complete; the scene's file is being unpacked.
    Unpacking,
}

/// The hash of the catalogue against which a downloaded file was checked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verified {
    /// The archive's hash is the catalogue's.
    Archive,
    /// The file's hash is the catalogue's; the catalogue has none of the archive.
    File,
    /// The catalogue has neither hash. The value is the file's SHA-256, hexadecimal.
    Unknown(String),
}

/// Downloads a scene into `folder` and returns the path of its file.
///
/// # Errors
/// [`Error::Input`] if the catalogue has no address, the file exists, the server refuses, a hash differs, or the
/// archive is broken or leaves its folder. [`Error::Output`] if the file cannot be written.
pub(crate) fn fetch(entry: &Entry, folder: &Path, watch: &mut dyn FnMut(Event)) -> Result<(PathBuf, Verified)> {
    let Some(archive) = &entry.fetch else {
        let problem = format!("no official address is known from which {} could be fetched", entry.name);
        return Err(Error::argument(&entry.name, problem, format!("get it by hand, from {}", entry.source)));
    };
    let known = entry.file.iter().find(|candidate| candidate.path == archive.to);
    fetch_archive(&entry.name, archive, known.and_then(|k| k.sha256.as_deref()), folder, READ_TIMEOUT, watch)
}

/// Downloads one file of an archive. `sha256` is the hash of that file, if it is known; after `read_timeout` without a
/// byte the connection counts as broken.
///
/// # Errors
/// As [`fetch`].
pub fn fetch_archive(
    name: &str,
    archive: &Archive,
    sha256: Option<&str>,
    folder: &Path,
    read_timeout: Duration,
    watch: &mut dyn FnMut(Event),
) -> Result<(PathBuf, Verified)> {
    let target = folder.join(&archive.to);
    if target.exists() {
        return Err(Error::file(&target, None, "it is there already", "nothing is overwritten: remove it first"));
    }
    let home = target.parent().unwrap_or(folder);
    fs::create_dir_all(home).map_err(|e| Error::output(home, e))?;
    let download = home.join(format!(".{name}.tar.gz.part"));
    download_to(&archive.url, &download, read_timeout, watch)?;
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
        // This is checked again because another process may have created the file in the meantime.
        _ if target.exists() => Err(Error::file(&target, None, "it is there already", "nothing is overwritten")),
        _ => fs::rename(&unpacked, &target).map(|()| found).map_err(|e| Error::output(&target, e)),
    });
    // The archive is removed in any case: it is no longer needed, and a broken one must not be continued.
    discard(&download);
    let found = result.inspect_err(|_| discard(&unpacked))?;
    let verified = match (&archive.sha256, sha256) {
        (Some(_), _) => Verified::Archive,
        (None, Some(_)) => Verified::File,
        (None, None) => Verified::Unknown(found),
    };
    Ok((target, verified))
}

/// Removes a temporary file; errors are ignored.
fn discard(path: &Path) {
    let _ = fs::remove_file(path);
}

fn wrong_hash(url: &str, subject: &str, found: &str, expected: &str) -> Error {
    let problem = format!("the {subject} is not the expected one: its SHA-256 is {found}, not {expected}");
    Error::argument(url, problem, "it was removed; try again, or get the scene by hand")
}

/// Downloads until the file is complete; continues a partial file at `path`.
fn download_to(url: &str, path: &Path, read_timeout: Duration, watch: &mut dyn FnMut(Event)) -> Result<()> {
    let config = ureq::Agent::config_builder()
        // A redirect must not lead from https to http.
        .https_only(url.starts_with("https://"))
        .http_status_as_error(false)
        .timeout_connect(Some(Duration::from_secs(30)))
        .timeout_recv_response(Some(read_timeout))
        .user_agent(concat!("rtbench/", env!("CARGO_PKG_VERSION")))
        .build();
    let agent = ureq::Agent::new_with_config(config);
    let mut failures = 0;
    loop {
        let before = fs::metadata(path).map_or(0, |m| m.len());
        match attempt(&agent, url, path, before, read_timeout, watch)? {
            Attempt::Done => return Ok(()),
            Attempt::Broken(reason) => {
                let progress = fs::metadata(path).map_or(0, |m| m.len()) > before;
                failures = if progress { 0 } else { failures + 1 };
                if failures >= MAX_ATTEMPTS {
                    let hint = "check the connection; the next attempt continues where this one ended";
                    return Err(Error::argument(url, format!("the download breaks off: {reason}"), hint));
                }
                watch(Event::Retry(reason));
                std::thread::sleep(Duration::from_millis(200 * u64::from(failures)));
            }
        }
    }
}

enum Attempt {
    Done,
    /// The attempt failed for this reason; another one may succeed.
    Broken(String),
}

/// Sends one request for the bytes from `have` on and appends the answer to the file at `path`.
fn attempt(
    agent: &ureq::Agent,
    url: &str,
    path: &Path,
    have: u64,
    read_timeout: Duration,
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
            // The header reads `bytes FIRST-LAST/TOTAL`.
            let range = header("content-range").and_then(|text| text.strip_prefix("bytes "));
            let first = range.and_then(|r| r.split('-').next()).and_then(number);
            let total = range.and_then(|r| r.rsplit('/').next()).and_then(number);
            if first != Some(have) {
                discard(path);
                return Ok(Attempt::Broken("the server continues at another byte than requested".into()));
            }
            (have, total)
        }
        416 => {
            // The partial file is at least as long as the server's: it is complete or another file. A new download
            // decides, by its hash.
            discard(path);
            let reason = "the server has no bytes after the partial file: the download starts from the beginning";
            return Ok(Attempt::Broken(reason.into()));
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
    // ureq can limit only the time of a whole body. A separate thread reads the body, so that a stalled read can be
    // abandoned; the thread ends with the connection.
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
        let piece = match pieces.recv_timeout(read_timeout) {
            Ok(Ok(piece)) => piece,
            Ok(Err(e)) => return Ok(Attempt::Broken(one_line(&e))),
            Err(RecvTimeoutError::Disconnected) => break,
            Err(RecvTimeoutError::Timeout) => {
                let reason = format!("the server has sent nothing for {} s", read_timeout.as_secs_f64());
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
        Some(total) if done < total => {
            Ok(Attempt::Broken(format!("the connection ended after {done} of {total} bytes")))
        }
        _ => Ok(Attempt::Done),
    }
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
            return Err(refuse(format!("the archive has the path {:?}, which leads outside of its folder", path)));
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

/// Copies a stream and returns its SHA-256, hexadecimal. `reading` and `writing` convert the errors of either side.
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
