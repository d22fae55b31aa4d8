//! What a certificate's file says of the flights that a scenario commands.

use fspid_proof::{Commanded, Commands, Leg, LegGroup, Shares};
use serde::{Deserialize, Serialize};

use super::steps_file::NearRest;

/// From which sample on, and which share of the size.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Change {
    from_sample: usize,
    share: f64,
}

fn changes(shares: &Shares) -> Vec<Change> {
    shares.0.iter().map(|&(from_sample, share)| Change { from_sample, share }).collect()
}

fn shares(changes: &[Change]) -> Shares {
    Shares(changes.iter().map(|it| (it.from_sample, it.share)).collect())
}

/// What is commanded with the parts that it is flown in, and the form near rest.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CommandedFile {
    setpoint_rad: f64,
    load_rad: f64,
    setpoint: Vec<Change>,
    at_servo: Vec<Change>,
    at_elevator: Vec<Change>,
    legs: Vec<LegFile>,
    near_rest: NearRest,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct LegFile {
    from_sample: usize,
    groups: Vec<GroupFile>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct GroupFile {
    of: Vec<usize>,
    setpoints_rad: Vec<f64>,
    loads_rad: Vec<f64>,
}

impl GroupFile {
    fn of(group: &LegGroup) -> Self {
        let LegGroup { of, setpoints_rad, loads_rad } = group.clone();
        Self { of, setpoints_rad, loads_rad }
    }

    fn build(&self) -> LegGroup {
        let Self { of, setpoints_rad, loads_rad } = self.clone();
        LegGroup { of, setpoints_rad, loads_rad }
    }
}

impl CommandedFile {
    pub(super) fn of(commanded: &Commanded) -> Self {
        let Commanded { commands, terminal, legs } = commanded;
        let Commands { setpoint_rad, load_rad, setpoint, at_servo, at_elevator } = commands;
        let leg = |Leg { from_sample, groups }: &Leg| LegFile {
            from_sample: *from_sample,
            groups: groups.iter().map(GroupFile::of).collect(),
        };
        Self {
            setpoint_rad: *setpoint_rad,
            load_rad: *load_rad,
            setpoint: changes(setpoint),
            at_servo: changes(at_servo),
            at_elevator: changes(at_elevator),
            legs: legs.iter().map(leg).collect(),
            near_rest: NearRest::of(terminal),
        }
    }

    pub(super) fn build(&self) -> Result<Commanded, String> {
        let Self { setpoint_rad, load_rad, setpoint, at_servo, at_elevator, legs, near_rest } =
            self;
        let leg = |LegFile { from_sample, groups }: &LegFile| Leg {
            from_sample: *from_sample,
            groups: groups.iter().map(GroupFile::build).collect(),
        };
        let [setpoint, at_servo, at_elevator] =
            [setpoint, at_servo, at_elevator].map(|changes| shares(changes));
        let (setpoint_rad, load_rad) = (*setpoint_rad, *load_rad);
        Ok(Commanded {
            commands: Commands { setpoint_rad, load_rad, setpoint, at_servo, at_elevator },
            terminal: near_rest.build()?,
            legs: legs.iter().map(leg).collect(),
        })
    }
}
