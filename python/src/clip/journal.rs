//! The file of a clip's journal, which one clip alone has open.

use std::ffi::OsString;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use crate::errors::Failure;

pub(crate) struct Journal {
    path: PathBuf,
    /// Locked as long as it is open.
    file: File,
    /// Number of bytes that are written completely.
    length: u64,
    /// Whether all of them survive the end of the machine.
    is_synced: bool,
    /// What is still to be written: more than nothing only after a failure.
    waiting: Vec<u8>,
    /// Whether that takes the place of what is in the file.
    replaces: bool,
}

impl Journal {
    /// Opens a file, or makes an empty one. Returns it with its content.
    pub(crate) fn open(path: PathBuf) -> Result<(Journal, Vec<u8>), Failure> {
        let name = path.display().to_string();
        let failed = |error: io::Error| Failure {
            code: if error.kind() == ErrorKind::NotFound { "file-not-found" } else { "unreadable-file" },
            message: format!("the journal '{name}' cannot be opened: {error}"),
        };
        let mut file = opened(&path).map_err(failed)?;
        if !(lock(&file).map_err(failed)? && is_at(&file, &path).map_err(failed)?) {
            return Err(Failure::option("journal", &format!("another clip has '{name}' open: close it first")));
        }
        // The folder of the process may be another one when the file is replaced.
        let path = fs::canonicalize(&path).map_err(failed)?;
        let mut content = Vec::new();
        file.read_to_end(&mut content).map_err(failed)?;
        Ok((
            Journal { path, file, length: content.len() as u64, is_synced: true, waiting: Vec::new(), replaces: false },
            content,
        ))
    }

    /// Cuts off what follows the bytes that could be read. If that is damaged, all of the content is copied beside the file before, and a
    /// sentence about it is returned.
    pub(crate) fn cut(&mut self, content: &[u8], used: usize, is_damaged: bool) -> Result<Option<String>, Failure> {
        if used == content.len() {
            return Ok(None);
        }
        let copy = Some(beside(&self.path, ".damaged")).filter(|_| is_damaged);
        let copied = copy.as_ref().map_or(Ok(()), |copy| written(&mut File::create(copy)?, content));
        let cut = copied.and_then(|()| self.file.set_len(used as u64)).and_then(|()| self.file.sync_all());
        cut.map_err(|error| self.failed(&error))?;
        self.length = used as u64;
        Ok(copy.map(|copy| {
            let place = copy.display();
            format!("the journal is damaged, and steps after that point could not be read: all of it is in '{place}'")
        }))
    }

    /// Appends records, or replaces the file. What could not be written is written with the next records.
    pub(crate) fn write(&mut self, records: &[u8], replaces: bool) -> Result<(), Failure> {
        if replaces {
            self.waiting.clear();
            self.replaces = true;
        }
        self.waiting.extend_from_slice(records);
        if self.waiting.is_empty() {
            return Ok(());
        }
        let written = if self.replaces { self.replace() } else { self.append() };
        written.map_err(|error| self.failed(&error))?;
        self.waiting.clear();
        self.replaces = false;
        Ok(())
    }

    /// Waits until what was written survives the end of the machine.
    pub(crate) fn sync(&mut self) -> Result<(), Failure> {
        if !self.is_synced {
            self.file.sync_data().map_err(|error| self.failed(&error))?;
            self.is_synced = true;
        }
        Ok(())
    }

    fn append(&mut self) -> io::Result<()> {
        self.file.seek(SeekFrom::Start(self.length))?;
        self.file.write_all(&self.waiting)?;
        self.length += self.waiting.len() as u64;
        self.is_synced = false;
        Ok(())
    }

    /// Writes a file beside it and puts it in its place: at any time there is one of the two.
    fn replace(&mut self) -> io::Result<()> {
        let new = beside(&self.path, ".new");
        let mut file = opened(&new)?;
        if !lock(&file)? {
            return Err(ErrorKind::ResourceBusy.into());
        }
        file.set_len(0)?;
        written(&mut file, &self.waiting)?;
        fs::rename(&new, &self.path)?;
        // Not every system can wait for the entries of a folder.
        let _ = self.path.parent().map(|folder| File::open(folder).and_then(|folder| folder.sync_all()));
        (self.file, self.length, self.is_synced) = (file, self.waiting.len() as u64, true);
        Ok(())
    }

    fn failed(&self, error: &io::Error) -> Failure {
        let message = format!("the journal '{}' cannot be written: {error}", self.path.display());
        Failure { code: "write-failed", message }
    }
}

/// Writes all bytes, and waits until they are kept.
fn written(file: &mut File, bytes: &[u8]) -> io::Result<()> {
    file.write_all(bytes)?;
    file.sync_all()
}

fn opened(path: &Path) -> io::Result<File> {
    OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path)
}

/// Whether nobody else had it locked.
fn lock(file: &File) -> io::Result<bool> {
    match file.try_lock() {
        Ok(()) => Ok(true),
        Err(TryLockError::WouldBlock) => Ok(false),
        Err(TryLockError::Error(error)) => Err(error),
    }
}

/// Whether a file that was opened is still at its path: the clip that had it locked may have replaced it since.
fn is_at(file: &File, path: &Path) -> io::Result<bool> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        let [opened, there] = [file.metadata()?, fs::metadata(path)?].map(|of| (of.dev(), of.ino()));
        Ok(opened == there)
    }
    #[cfg(not(unix))]
    {
        let _ = (file, path);
        Ok(true)
    }
}

fn beside(path: &Path, end: &str) -> PathBuf {
    let mut name = OsString::from(path);
    name.push(end);
    name.into()
}
