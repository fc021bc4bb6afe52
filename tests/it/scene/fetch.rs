//! Tests of downloads from a local server: success, wrong hashes, broken connections, redirects, refusals, archives
//! with paths outside of their folder.

use flate2::Compression;
use flate2::write::GzEncoder;
use rtbench::fetch::{Event, Verified, fetch_archive};
use rtbench::scene::catalogue::Archive;
use sha2::{Digest, Sha256};
use std::io::{BufRead, BufReader, Write};
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, channel};

/// The answer of the server to a request.
#[derive(Clone)]
enum Answer {
    /// Sends everything, or the requested range.
    Serve(Vec<u8>),
    /// Sends everything, and ignores a requested range.
    Whole(Vec<u8>),
    /// Announces everything, sends this number of bytes, and closes the connection.
    Cut(Vec<u8>, usize),
    /// Announces everything, sends this number of bytes, and keeps the connection open.
    Silent(Vec<u8>, usize),
    /// Redirects to this address.
    Redirect(String),
    /// Sends a status without a body.
    Status(&'static str),
}

/// Answers the requests in order, each on a separate connection. The receiver gets the `Range` of each request.
fn server(answers: Vec<Answer>) -> (String, Receiver<Option<String>>) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let url = format!("http://{}/a.tar.gz", listener.local_addr().unwrap());
    let (report, reports) = channel();
    std::thread::spawn(move || {
        for answer in answers {
            let (mut stream, _) = listener.accept().unwrap();
            let lines = BufReader::new(stream.try_clone().unwrap()).lines().map(Result::unwrap);
            let head: Vec<String> = lines.take_while(|line| !line.is_empty()).collect();
            let range = head.iter().find_map(|l| l.to_lowercase().strip_prefix("range: ").map(str::to_owned));
            let first: Option<usize> =
                range.as_deref().and_then(|r| r.strip_prefix("bytes=")?.strip_suffix('-')?.parse().ok());
            let _ = report.send(range);
            let head = |status: &str, extra: String| format!("HTTP/1.1 {status}\r\nConnection: close\r\n{extra}\r\n");
            let silent = matches!(answer, Answer::Silent(..));
            let (head, body) = match (answer, first) {
                (Answer::Serve(bytes), Some(first)) if first >= bytes.len() => {
                    (head("416 Range Not Satisfiable", "Content-Length: 0\r\n".into()), Vec::new())
                }
                (Answer::Serve(bytes), Some(first)) => {
                    let (last, total, rest) = (bytes.len() - 1, bytes.len(), bytes[first..].to_vec());
                    let range =
                        format!("Content-Range: bytes {first}-{last}/{total}\r\nContent-Length: {}\r\n", rest.len());
                    (head("206 Partial Content", range), rest)
                }
                (Answer::Serve(bytes) | Answer::Whole(bytes), _) => {
                    (head("200 OK", format!("Content-Length: {}\r\n", bytes.len())), bytes)
                }
                (Answer::Cut(bytes, sent) | Answer::Silent(bytes, sent), _) => {
                    (head("200 OK", format!("Content-Length: {}\r\n", bytes.len())), bytes[..sent].to_vec())
                }
                (Answer::Redirect(to), _) => {
                    (head("302 Found", format!("Location: {to}\r\nContent-Length: 0\r\n")), Vec::new())
                }
                (Answer::Status(status), _) => (head(status, "Content-Length: 0\r\n".into()), Vec::new()),
            };
            // The client may have closed the connection.
            let _ = stream.write_all(head.as_bytes()).and_then(|()| stream.write_all(&body));
            if silent {
                std::mem::forget(stream);
            }
        }
    });
    (url, reports)
}

/// A tar.gz. Names are written unchanged; the builder of the crate `tar` would refuse invalid ones.
fn archive(entries: &[(&str, tar::EntryType, &[u8])]) -> Vec<u8> {
    let mut builder = tar::Builder::new(GzEncoder::new(Vec::new(), Compression::default()));
    for (name, kind, content) in entries {
        let mut header = tar::Header::new_gnu();
        header.as_gnu_mut().unwrap().name[..name.len()].copy_from_slice(name.as_bytes());
        header.set_size(content.len() as u64);
        header.set_entry_type(*kind);
        header.set_mode(0o644);
        header.set_cksum();
        builder.append(&header, *content).unwrap();
    }
    builder.into_inner().unwrap().finish().unwrap()
}

const FILE: tar::EntryType = tar::EntryType::Regular;

/// Noise, which cannot be compressed.
fn content() -> Vec<u8> {
    let mut random = crate::support::random(7);
    (0..300_000).map(|_| (random() * 128.0) as i8 as u8).collect()
}

fn good() -> Vec<u8> {
    archive(&[("x/", tar::EntryType::Directory, b""), ("./x/README", FILE, b"hello"), ("x/mesh.ply", FILE, &content())])
}

fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The read timeout: long enough for a busy machine, short enough for a test.
const READ_TIMEOUT: std::time::Duration = std::time::Duration::from_secs(3);

/// The result of a download.
struct Fetched {
    result: rtbench::Result<(PathBuf, Verified)>,
    events: Vec<Event>,
    ranges: Vec<Option<String>>,
}

fn fetch(answers: Vec<Answer>, hashes: [Option<&str>; 2], folder: &Path) -> Fetched {
    let (url, reports) = server(answers);
    let archive =
        Archive { url, sha256: hashes[0].map(str::to_owned), member: "x/mesh.ply".into(), to: "deep/mesh.ply".into() };
    let mut events = Vec::new();
    let result = fetch_archive("test", &archive, hashes[1], folder, READ_TIMEOUT, &mut |event| events.push(event));
    Fetched { result, events, ranges: reports.try_iter().collect() }
}

/// The relative paths of all files in a folder.
fn listing(folder: &Path) -> Vec<String> {
    let mut names = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(inner) = folders.pop() {
        for entry in std::fs::read_dir(inner).unwrap() {
            let path = entry.unwrap().path();
            match path.is_dir() {
                true => folders.push(path),
                false => names.push(path.strip_prefix(folder).unwrap().display().to_string()),
            }
        }
    }
    names.sort();
    names
}

fn refused(fetched: Fetched, words: &str) {
    let message = fetched.result.expect_err(words).to_string();
    assert!(message.contains(words) && !message.contains('\n'), "{words}: {message}");
}

#[test]
fn a_download_reports_how_it_was_verified() {
    let (archive_hash, file_hash) = (sha256(&good()), sha256(&content()));
    for (hashes, verified) in [
        ([Some(archive_hash.as_str()), Some(file_hash.as_str())], Verified::Archive),
        ([None, Some(file_hash.as_str())], Verified::File),
        ([None, None], Verified::Unknown(file_hash.clone())),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let fetched = fetch(vec![Answer::Serve(good())], hashes, folder.path());
        let (path, found) = fetched.result.unwrap();
        assert_eq!((path.strip_prefix(folder.path()).unwrap(), found), (Path::new("deep/mesh.ply"), verified));
        assert!(std::fs::read(&path).unwrap() == content());
        assert_eq!(listing(folder.path()), ["deep/mesh.ply"], "there is no other file");
        let total = good().len() as u64;
        assert_eq!(fetched.events.first(), Some(&Event::Downloaded(0, Some(total))));
        assert!(fetched.events.contains(&Event::Downloaded(total, Some(total))));
        assert_eq!(fetched.events.last(), Some(&Event::Unpacking));
    }
}

#[test]
fn no_file_is_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("deep")).unwrap();
    std::fs::write(folder.path().join("deep/mesh.ply"), "mine").unwrap();
    refused(fetch(vec![], [None, None], folder.path()), "it is there already");
    assert_eq!(std::fs::read(folder.path().join("deep/mesh.ply")).unwrap(), b"mine");
}

#[test]
fn a_wrong_hash_leaves_no_file() {
    let wrong = "0".repeat(64);
    for (hashes, what) in
        [([Some(wrong.as_str()), None], "the archive is not"), ([None, Some(wrong.as_str())], "the file is not")]
    {
        let folder = tempfile::tempdir().unwrap();
        let fetched = fetch(vec![Answer::Serve(good())], hashes, folder.path());
        // With a wrong hash of the archive, nothing is unpacked.
        assert_eq!(fetched.events.contains(&Event::Unpacking), hashes[0].is_none());
        refused(fetched, what);
        assert!(listing(folder.path()).is_empty());
    }
}

#[test]
fn a_broken_download_is_continued() {
    let folder = tempfile::tempdir().unwrap();
    let cut = 100_000;
    let fetched =
        fetch(vec![Answer::Cut(good(), cut), Answer::Serve(good())], [Some(&sha256(&good())), None], folder.path());
    fetched.result.unwrap();
    assert_eq!(fetched.ranges, [None, Some(format!("bytes={cut}-"))]);
    assert!(fetched.events.iter().any(|event| matches!(event, Event::Retry(_))));
    // If the connection always breaks, the download fails, the received bytes are kept, and the next call continues.
    let folder = tempfile::tempdir().unwrap();
    let broken = vec![
        Answer::Cut(good(), cut),
        Answer::Status("503 Busy"),
        Answer::Status("503 Busy"),
        Answer::Status("503 Busy"),
    ];
    refused(fetch(broken, [None, None], folder.path()), "breaks off");
    assert_eq!(listing(folder.path()), ["deep/.test.tar.gz.part"]);
    let fetched = fetch(vec![Answer::Serve(good())], [None, None], folder.path());
    assert!(std::fs::read(fetched.result.unwrap().0).unwrap() == content());
    assert_eq!(fetched.ranges, [Some(format!("bytes={cut}-"))]);
    assert_eq!(listing(folder.path()), ["deep/mesh.ply"]);
}

#[test]
fn a_stalled_download_times_out() {
    let folder = tempfile::tempdir().unwrap();
    let half = good().len() / 2;
    let answers = vec![Answer::Silent(good(), half), Answer::Serve(good())];
    let fetched = fetch(answers, [Some(&sha256(&good())), None], folder.path());
    assert!(std::fs::read(fetched.result.unwrap().0).unwrap() == content());
    assert_eq!(fetched.ranges, [None, Some(format!("bytes={half}-"))]);
    let again = |event: &Event| matches!(event, Event::Retry(reason) if reason.contains("has sent nothing for 3 s"));
    assert!(fetched.events.iter().any(again), "{:?}", fetched.events.last());
}

#[test]
fn a_download_that_cannot_be_continued_starts_again() {
    // The server does not support ranges; the partial file is longer than the archive.
    for (left, answers) in
        [(100, vec![Answer::Whole(good())]), (500_000, vec![Answer::Serve(good()), Answer::Serve(good())])]
    {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("deep")).unwrap();
        std::fs::write(folder.path().join("deep/.test.tar.gz.part"), vec![1; left]).unwrap();
        let fetched = fetch(answers, [Some(&sha256(&good())), None], folder.path());
        assert!(std::fs::read(fetched.result.unwrap().0).unwrap() == content(), "{left}");
    }
    // A partial file of another archive is detected, and not continued twice.
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("deep")).unwrap();
    std::fs::write(folder.path().join("deep/.test.tar.gz.part"), vec![1; 1000]).unwrap();
    refused(fetch(vec![Answer::Serve(good())], [Some(&sha256(&good())), None], folder.path()), "the archive is not");
    assert!(listing(folder.path()).is_empty());
}

#[test]
fn redirects_are_followed_and_refusals_reported() {
    let folder = tempfile::tempdir().unwrap();
    let (there, _) = server(vec![Answer::Serve(good())]);
    fetch(vec![Answer::Redirect(there)], [Some(&sha256(&good())), None], folder.path()).result.unwrap();
    let folder = tempfile::tempdir().unwrap();
    refused(fetch(vec![Answer::Status("404 Not Found")], [None, None], folder.path()), "the server answers 404");
    let loops: Vec<Answer> = vec![Answer::Redirect("/a.tar.gz".into()); 20];
    refused(fetch(loops, [None, None], folder.path()), "redirect");
    assert!(listing(folder.path()).is_empty());
}

#[test]
fn an_archive_cannot_leave_its_folder() {
    let mesh = content();
    for (bad, words) in [
        (archive(&[("x/mesh.ply", FILE, &mesh), ("../evil", FILE, b"evil")]), "outside of its folder"),
        (archive(&[("x/../../evil", FILE, b"evil"), ("x/mesh.ply", FILE, &mesh)]), "outside of its folder"),
        (archive(&[("/tmp/evil", FILE, b"evil"), ("x/mesh.ply", FILE, &mesh)]), "outside of its folder"),
        (archive(&[("x/mesh.ply", tar::EntryType::Symlink, b"")]), "no plain file"),
        (archive(&[("x/mesh.plx", FILE, &mesh)]), "the archive has no x/mesh.ply"),
        (b"this is no archive".to_vec(), "the archive is broken"),
        (good()[..good().len() / 2].to_vec(), "the archive is broken"),
    ] {
        let outer = tempfile::tempdir().unwrap();
        let folder = outer.path().join("scenes");
        refused(fetch(vec![Answer::Serve(bad)], [None, None], &folder), words);
        assert!(listing(outer.path()).is_empty(), "{words}");
    }
}
