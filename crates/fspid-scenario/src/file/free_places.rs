//! Whether what is marked free is free wherever it is tuned. What is tuned is put into the scenario last, so that a number
//! which a case sets at its place would be told and not flown; and of a number that is drawn at its place, nothing that is
//! tuned would be left.

use super::Template;
use crate::dispersion::Dispersion;
use crate::setting_path::{SettingPath, Step};
use crate::tuning::{Case, TunableParameter};
use fspid_diagnostics::{Problems, Report};

/// Which flights are asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum TunedIn {
    /// Those of the scenario as it is written, with what dispersions draw.
    AsWritten,
    /// And those of the cases that it is tuned on.
    Tuning,
    /// And those of the cases that a contest judges on.
    Contest,
}

impl Template {
    /// Refuses a place of these marks that a dispersion draws a value for, whatever was tuned, and one that a case sets.
    ///
    /// A relative draw is allowed: it is a factor of what is tuned.
    ///
    /// # Errors
    /// Every such dispersion and every such case, by name.
    pub fn check_free(
        &self,
        marks: &[TunableParameter],
        tuned_in: TunedIn,
    ) -> Result<(), Problems> {
        let mut report = self.report();
        for (index, dispersion) in self.study().dispersions.iter().enumerate() {
            if let Some(path) = self.drawn_absolutely(marks, dispersion) {
                let at = format!("dispersion[{index}]");
                let message = format!(
                    "it draws a value for `{}`, which is marked free: nothing that is tuned there would fly",
                    path.text()
                );
                let allowed = "relative = true, so that draws are factors of what is tuned; or a number in place of the mark";
                report.missing(self.place_of(&at), &at, message, allowed);
            }
        }
        let study = self.study();
        let tuning = study.tuning.iter().flat_map(|it| &it.cases).enumerate();
        let contest = study.contest.iter().flat_map(|it| &it.cases).enumerate();
        let tuning = tuning.filter(|_| tuned_in >= TunedIn::Tuning);
        let contest = contest.filter(|_| tuned_in >= TunedIn::Contest);
        for (index, case) in tuning {
            self.check_case(&mut report, marks, (&format!("tuning.case[{index}]"), case));
        }
        for (index, case) in contest {
            self.check_case(&mut report, marks, (&format!("contest.case[{index}]"), case));
        }
        report.finish(self.name()).map(|_| ())
    }

    /// True for a path that leads to the place of one of these marks, into it, or around it.
    #[must_use]
    pub fn leads_to(&self, marks: &[TunableParameter], path: &SettingPath) -> bool {
        self.mark_at(marks, path).is_some()
    }

    /// A path by the name of its controller, as it leads to the same place where other controllers are left out; none for a
    /// path to another controller.
    #[must_use]
    pub fn path_of_only(&self, controller: &str, path: &SettingPath) -> Option<SettingPath> {
        let numbered = self.numbered(path);
        let [Step::Name(list), Step::Index(index), rest @ ..] = &numbered[..] else {
            return Some(path.clone());
        };
        if list != "controller" {
            return Some(path.clone());
        }
        (self.controller_at(*index).as_deref() == Some(controller)).then(|| {
            let begin = [Step::Name(list.clone()), Step::Name(controller.to_owned())];
            SettingPath::of(begin.into_iter().chain(rest.iter().cloned()).collect())
        })
    }

    fn drawn_absolutely<'a>(
        &self,
        marks: &[TunableParameter],
        dispersion: &'a Dispersion,
    ) -> Option<&'a SettingPath> {
        let mut paths = dispersion.targets.iter().flat_map(|target| &target.paths);
        paths.find(|path| !dispersion.relative && self.leads_to(marks, path))
    }

    fn check_case(
        &self,
        report: &mut Report,
        marks: &[TunableParameter],
        (at, case): (&str, &Case),
    ) {
        for change in &case.set {
            // What is wrong with a change itself is told where the case is read.
            let Some((path, _)) = change.split_once('=') else { continue };
            // An entry more is no other place.
            if path.trim().ends_with("[]") {
                continue;
            }
            let Some(path) = SettingPath::parse(path) else { continue };
            let Some(mark) = self.mark_at(marks, &path) else { continue };
            let message = format!(
                "case \"{}\" sets `{}`, which is marked free: what is tuned would fly in its place",
                case.name,
                mark.path.text()
            );
            let allowed = "cases that set no marked number: take this change out, or the mark";
            let set = format!("{at}.set");
            report.missing(self.place_of(&set), &set, message, allowed);
        }
    }

    fn mark_at<'a>(
        &self,
        marks: &'a [TunableParameter],
        path: &SettingPath,
    ) -> Option<&'a TunableParameter> {
        let here = self.numbered(path);
        marks.iter().find(|mark| {
            let there = self.numbered(&mark.path);
            here.iter().zip(&there).all(|(one, other)| one == other)
        })
    }
}
