//! The last check of what has been read.

use fspid_fuzzy::system::{Parts, System};

use crate::note::Reading;
use crate::report::Report;
use fspid_diagnostics::Problems;

/// The reading, unless there are problems; what only the system as a whole shows is found here.
pub(crate) fn complete(parts: Parts, mut report: Report) -> Result<Reading, Problems> {
    if report.is_clean()
        && let Err(errors) = System::new(parts.clone())
    {
        errors.iter().for_each(|error| report.whole(error.to_string()));
    }
    Ok(Reading { parts, notes: report.finish()? })
}
