//! fspid-lti
