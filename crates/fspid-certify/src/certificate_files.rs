//! Certificates as files: how each is called, and that what is written can be read again.

use super::cases::CertifiedCases;
use super::file::{from_text, to_text};
use super::no_certificate::NoCertificate;
use super::{Certification, Certified};

/// A certificate as a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CertificateFile {
    /// Its name, with that of its case before it and `/` between where there are cases; no other certificate of the answer has
    /// it.
    pub name: String,
    /// What it holds.
    pub text: String,
    /// The changes of its case, as `--set` takes them: it is held against the scenario with them.
    pub set: Vec<String>,
}

/// Why no certificate can be written: what it holds could not be read again, since a number of the scenario is beyond all
/// ranges.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no certificate can be written of {controller}:\n{refused}")]
pub struct NotWritable {
    /// Of whom.
    pub controller: String,
    /// What is wrong with it.
    #[source]
    pub refused: NoCertificate,
}

impl Certification {
    /// A file for each loop that has a certificate.
    ///
    /// # Errors
    /// [`NotWritable`] of the first that could not be read again.
    pub fn certificate_files(&self) -> Result<Vec<CertificateFile>, NotWritable> {
        self.results.iter().filter_map(|it| self.certificate_file(it)).collect()
    }

    fn certificate_file(
        &self,
        certified: &Certified,
    ) -> Option<Result<CertificateFile, NotWritable>> {
        let text = to_text(certified.certificate()?, &certified.origin);
        Some(match from_text(&text) {
            Ok(_) => Ok(CertificateFile { name: self.file_name(certified), text, set: Vec::new() }),
            Err(refused) => Err(NotWritable { controller: certified.controller.clone(), refused }),
        })
    }

    /// In a sentence for each, certificates that are not called as their controller is.
    #[must_use]
    pub fn changed_names(&self) -> Vec<String> {
        let written = self.results.iter().filter(|it| it.certificate().is_some());
        written.filter_map(|it| self.files.told(&it.subject())).collect()
    }
}

impl CertifiedCases {
    /// As of a [`Certification`], each case in a folder of its own.
    ///
    /// # Errors
    /// [`NotWritable`] of the first that could not be read again.
    pub fn certificate_files(&self) -> Result<Vec<CertificateFile>, NotWritable> {
        let mut files = Vec::new();
        for case in self.cases() {
            let folder = self.folder(&case.change);
            let own = case.certification.certificate_files()?.into_iter();
            files.extend(own.map(|file| CertificateFile {
                name: format!("{folder}/{}", file.name),
                set: case.change.set.clone(),
                ..file
            }));
        }
        Ok(files)
    }

    /// As of a [`Certification`].
    #[must_use]
    pub fn changed_names(&self) -> Vec<String> {
        self.cases().iter().flat_map(|case| case.certification.changed_names()).collect()
    }
}
