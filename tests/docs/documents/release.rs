//! The packages that `scripts/release` builds from compiled programs.

use std::fs;
use std::process::Command;

use super::page::root;
use super::run::{Folder, programs};

/// A test: the package and the tarball contain both programs, which solve, with their manuals and licences.
pub fn solves() {
    if Command::new("dpkg-shlibdeps")
        .arg("--version")
        .output()
        .is_err()
    {
        eprintln!("skipped: there is no dpkg-shlibdeps");
        return;
    }
    let folder = Folder::new();
    let mut release = Command::new(root().join("scripts/release"));
    release.arg("made").env("PROGRAMS", programs());
    // Compression of packages that are discarded would take half of the time.
    release
        .env("DPKG_DEB_COMPRESSOR_TYPE", "none")
        .env("GZIP", "-1");
    let ended = folder.run(&mut release);
    assert_eq!(ended.code(), 0, "{}", ended.stderr);
    let unpack = "dpkg-deb -x made/*.deb package && mkdir tarball && tar -xf made/*.tar.gz -C tarball --strip-components=1
        cmp package/usr/bin/contact-dd-mpi tarball/bin/contact-dd-mpi
        zgrep -q 'Number of subdomains' tarball/share/man/man1/contact-dd-partition.1.gz
        grep -q '^# metis-sys' tarball/share/doc/contact-dd-mpi*/licences.txt
        grep -q '^faer 0.*: MIT' tarball/share/doc/contact-dd-mpi*/licences.txt
        dpkg-deb -f made/*.deb Depends | grep -E 'libhdf5.*, (openmpi-bin|mpich)$'
        cd tarball/bin
        ./contact-dd-partition --example granite -n 8 -o granite.h5
        mpirun -n 2 ./contact-dd-mpi granite.h5 --report report.json";
    let ended = folder.run(Command::new("bash").args(["-euc", unpack]));
    assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
    let report = fs::read_to_string(folder.path().join("tarball/bin/report.json")).unwrap();
    let report: serde_json::Value = serde_json::from_str(&report).unwrap();
    assert_eq!(
        (&report["ranks"], &report["active_contacts"]),
        (&2.into(), &31.into())
    );
}
