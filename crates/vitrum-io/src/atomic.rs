//! Writes a file beside its name and renames it: a failure leaves the old file as it was, and no half of a new one.
//!
//! The new file takes over the permissions of the one that it replaces. A symbolic link is followed, so that its
//! target is replaced and not the link. Devices, pipes and write-protected files are never replaced.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

/// A file that could not be written. The file that was there before, if any, is unchanged.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The folder to write into does not exist.
    #[error("{}: there is no folder {}; create it or choose another", path.display(), folder.display())]
    FolderMissing {
        /// The file to write.
        path: PathBuf,
        /// Its folder.
        folder: PathBuf,
    },
    /// No file can be created in the folder.
    #[error(
        "{}: no file can be created in {} ({source}); change its permissions or choose another folder",
        path.display(), folder.display()
    )]
    FolderNotWritable {
        /// The file to write.
        path: PathBuf,
        /// Its folder.
        folder: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// There is something of that name that a file should not replace.
    #[error("{}: this is {found}; choose another name", path.display())]
    NotReplaceable {
        /// The file to write.
        path: PathBuf,
        /// What stands there.
        found: &'static str,
    },
    /// Writing, closing or renaming failed.
    #[error("{}: the file cannot be written ({source}); {}", path.display(), advice(source))]
    Failed {
        /// The file to write.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
}

/// What to do about a failure in mid-writing.
fn advice(error: &io::Error) -> &'static str {
    match error.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded | io::ErrorKind::FileTooLarge => {
            "free some space or choose another disk"
        }
        _ => "check the disk or choose another folder",
    }
}

/// Creates or replaces a file by what `write` writes.
///
/// # Errors
/// When there is no such folder, nothing can be created in it, the name is taken by something else than a file, or
/// writing fails: then nothing has changed.
pub(crate) fn replace(
    path: &Path,
    write: impl FnOnce(&mut File) -> io::Result<()>,
) -> Result<(), WriteError> {
    let target = Target::check(path)?;
    let (mut file, mut temporary) = target.create_temporary(path)?;
    let finish = || {
        write(&mut file)?;
        // Some disks find out that they are full only now.
        file.sync_all()?;
        drop(file);
        if let Some(permissions) = &target.permissions {
            fs::set_permissions(&temporary.path, permissions.clone())?;
        }
        fs::rename(&temporary.path, &target.path)?;
        temporary.is_renamed = true;
        Ok(())
    };
    finish().map_err(|source| WriteError::Failed { path: path.to_owned(), source })
}

/// Whether [`replace`] could begin: for finding out before the work rather than after it.
///
/// # Errors
/// As [`replace`], except for what only writing shows.
pub(crate) fn check(path: &Path) -> Result<(), WriteError> {
    Target::check(path)?.create_temporary(path).map(|_| ())
}

/// Where to write, with symbolic links followed, and the permissions of the file to replace.
struct Target {
    path: PathBuf,
    folder: PathBuf,
    permissions: Option<fs::Permissions>,
}

impl Target {
    fn check(path: &Path) -> Result<Self, WriteError> {
        let not_replaceable = |found| Err(WriteError::NotReplaceable { path: path.to_owned(), found });
        if path.file_name().is_none() {
            return not_replaceable("not the name of a file");
        }
        let metadata = fs::metadata(path).ok();
        let permissions = match &metadata {
            Some(metadata) if metadata.is_dir() => return not_replaceable("a folder"),
            Some(metadata) if !metadata.is_file() => return not_replaceable("a device or a pipe"),
            Some(metadata) if metadata.permissions().readonly() => return not_replaceable("write-protected"),
            found => found.as_ref().map(fs::Metadata::permissions),
        };
        let followed = if path.is_symlink() { fs::canonicalize(path).ok() } else { None };
        let target = followed.unwrap_or_else(|| path.to_owned());
        let folder = match target.parent() {
            Some(parent) if parent != Path::new("") => parent.to_owned(),
            _ => PathBuf::from("."),
        };
        if !folder.is_dir() {
            return Err(WriteError::FolderMissing { path: path.to_owned(), folder });
        }
        Ok(Self { path: target, folder, permissions })
    }

    /// A new, empty file in the target's folder, under a name that no other has.
    fn create_temporary(&self, path: &Path) -> Result<(File, Temporary), WriteError> {
        let process = std::process::id();
        let mut attempt = 0_u32;
        loop {
            let temporary = self.folder.join(format!(".vitrum-{process}-{attempt}.tmp"));
            match File::create_new(&temporary) {
                Ok(file) => return Ok((file, Temporary { path: temporary, is_renamed: false })),
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists && attempt < 1000 => attempt += 1,
                Err(source) => {
                    let (path, folder) = (path.to_owned(), self.folder.clone());
                    return Err(WriteError::FolderNotWritable { path, folder, source });
                }
            }
        }
    }
}

/// A file that goes away with this value, unless it was renamed before.
struct Temporary {
    path: PathBuf,
    is_renamed: bool,
}

impl Drop for Temporary {
    fn drop(&mut self) {
        // After the renaming the name is free, and may already be that of another thread's temporary file.
        if !self.is_renamed {
            // There is nothing to do about a failure.
            let _ = fs::remove_file(&self.path);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("a folder");
        let mut names: Vec<_> = entries
            .map(|entry| entry.expect("readable").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_file_is_created_and_replaced() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("a");
        for text in ["first", "second"] {
            check(&path).expect("writable");
            replace(&path, |file| file.write_all(text.as_bytes())).expect("writable");
            assert_eq!(fs::read_to_string(&path).expect("readable"), text);
        }
        assert_eq!(names(folder.path()), ["a"]);
    }

    #[test]
    fn a_failure_changes_nothing() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("a");
        fs::write(&path, "old").expect("writable");
        let full_disk = |file: &mut File| {
            file.write_all(b"half of the new")?;
            Err(io::ErrorKind::StorageFull.into())
        };
        let message = replace(&path, full_disk).expect_err("the disk is full").to_string();
        assert!(message.contains("free some space"), "{message}");
        assert_eq!(fs::read_to_string(&path).expect("readable"), "old");
        assert_eq!(names(folder.path()), ["a"]);
    }

    #[test]
    fn a_panic_while_writing_leaves_nothing_behind() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("a");
        let result = std::panic::catch_unwind(|| replace(&path, |_| panic!("in mid-writing")));
        assert!(result.is_err());
        assert!(names(folder.path()).is_empty());
    }

    #[test]
    fn what_is_in_the_way_is_named() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let protected = folder.path().join("protected");
        fs::write(&protected, "old").expect("writable");
        let mut permissions = fs::metadata(&protected).expect("there").permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&protected, permissions).expect("own file");
        let missing = folder.path().join("no/such/folder/a");
        let cases = [
            (folder.path(), "this is a folder"),
            (&missing, "there is no folder"),
            (&protected, "this is write-protected"),
            (Path::new(".."), "not the name of a file"),
        ];
        for (path, phrase) in cases {
            for result in [check(path), replace(path, |_| Ok(()))] {
                let message = result.expect_err("must fail").to_string();
                assert!(message.contains(phrase), "{message}");
            }
        }
        assert_eq!(fs::read_to_string(&protected).expect("readable"), "old");
        assert_eq!(names(folder.path()), ["protected"]);
    }

    #[cfg(unix)]
    #[test]
    fn devices_stay_and_links_are_followed() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().expect("a temporary folder");
        assert!(
            check(Path::new("/dev/null")).expect_err("a device").to_string().contains("a device or a pipe")
        );

        let (target, link) = (folder.path().join("target"), folder.path().join("link"));
        fs::write(&target, "old").expect("writable");
        fs::set_permissions(&target, fs::Permissions::from_mode(0o640)).expect("own file");
        symlink(&target, &link).expect("links are possible");
        replace(&link, |file| file.write_all(b"new")).expect("writable");
        assert!(link.is_symlink());
        assert_eq!(fs::read_to_string(&target).expect("readable"), "new");
        assert_eq!(fs::metadata(&target).expect("there").permissions().mode() & 0o777, 0o640);
    }

    /// A folder without write permission; for a user who may write everywhere, one of the kernel's.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_read_only_folder_says_so() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().expect("a temporary folder");
        fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o555)).expect("own folder");
        let may_write_anyway = File::create(folder.path().join("probe")).is_ok();
        let path = if may_write_anyway { Path::new("/proc/a").to_owned() } else { folder.path().join("a") };
        let message = check(&path).expect_err("read-only").to_string();
        assert!(message.contains("no file can be created in"), "{message}");
    }
}
