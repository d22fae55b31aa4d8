//! Who flies a campaign, where it is not this machine alone.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use clap::{Args, ValueEnum};
use fspid_campaign::{Campaign, Folder, Shards, shard};
use fspid_scenario::count as counts;
use fspid_study::{output, shell};
use serde_json::{Value, json};

use super::super::cluster::check_package;
use crate::argument::count;
use crate::exit::{Failure, note};

/// Who flies a campaign.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Engine {
    /// This machine, on its threads.
    Local,
    /// Ray, by the driver of the Python package: shards as tasks, flown again where a worker goes away.
    Ray,
    /// Dask's scheduler, the same way.
    Dask,
    /// Slurm: an array script in the folder, submitted, and the merge behind it.
    Slurm,
    /// Anything else: a line for each shard that is missing, and a manifest for Kubernetes in the folder.
    Command,
}

/// What engines other than this machine are asked.
#[derive(Debug, Args)]
pub(super) struct Cluster {
    /// Who flies.
    #[arg(long, value_enum, default_value_t = Engine::Local)]
    pub(super) engine: Engine,
    /// Where the cluster is: HOST:PORT, ray://HOST:PORT or auto of Ray; tcp://HOST:PORT of Dask. Without it Ray begins
    /// here.
    #[arg(long, value_name = "ADDRESS")]
    address: Option<String>,
    /// Where workers of Ray and Dask put parts by themselves: s3://BUCKET/PREFIX, gs://BUCKET/PREFIX or file:///FOLDER. In
    /// the end they are brought into the campaign's folder; without it they come through the driver.
    #[arg(long, value_name = "URL")]
    store: Option<String>,
    /// The Python that has the package fspid, for Ray and Dask.
    #[arg(long, value_name = "PROGRAM", default_value = "python3")]
    python: String,
    /// Tasks of Slurm's array, each of which flies its share of the shards.
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = count::<u64>(&counts::TASKS))]
    tasks: u64,
    /// The image with fspid in it, for the manifest.
    #[arg(long, value_name = "IMAGE", default_value = concat!("fspid:", env!("CARGO_PKG_VERSION")))]
    image: String,
}

/// What came of asking an engine.
pub(super) enum Asked {
    /// All of it is flown and merged.
    Merged,
    /// It is somebody else's now: what to tell, and the same for programs.
    Given(String, Value),
}

impl Cluster {
    /// Flies the campaign, or hands it over.
    pub(super) fn ask(&self, folder: &Folder, campaign: &Campaign) -> Result<Asked, Failure> {
        let place = std::path::absolute(folder.path()).map_err(Failure::output)?;
        match self.engine {
            Engine::Local => Ok(Asked::Merged),
            Engine::Ray => self.driven("ray", &place),
            Engine::Dask => self.driven("dask", &place),
            Engine::Slurm => self.submitted(&place, campaign),
            Engine::Command => self.listed(&place, folder, campaign),
        }
    }

    /// How a campaign is cut for whoever flies.
    pub(super) fn cut(&self) -> Shards {
        if self.engine == Engine::Local { Shards::ForThreads } else { Shards::ForWorkers }
    }

    /// Refuses a store where nobody would put anything into it.
    pub(super) fn check_store(&self) -> Result<(), Failure> {
        match (self.engine, &self.store) {
            (Engine::Ray | Engine::Dask, _) | (_, None) => Ok(()),
            _ => Err(Failure::input(
                "--store goes with --engine ray and dask; the others put parts into the campaign's folder",
            )),
        }
    }

    /// By the driver of the Python package.
    fn driven(&self, engine: &str, place: &Path) -> Result<Asked, Failure> {
        let python = &self.python;
        check_package(python, engine)?;
        let mut driver = Command::new(python);
        driver.args(["-m", "fspid.engines", engine]).arg(place).stdout(Stdio::null());
        if let Some(address) = &self.address {
            driver.args(["--address", address]);
        }
        if let Some(store) = &self.store {
            driver.args(["--store", store]);
        }
        let status =
            driver.status().map_err(|error| Failure::input(format_args!("{python}: {error}")))?;
        match status.code() {
            Some(0) => Ok(Asked::Merged),
            // It has told why.
            Some(code) if i32::from(Failure::OUTPUT) == code => Err(Failure::output("")),
            Some(code) if i32::from(Failure::INTERRUPTED) == code => Err(Failure::interrupted("")),
            _ => Err(Failure::input("")),
        }
    }

    /// As an array of Slurm, with the merge behind it.
    fn submitted(&self, place: &Path, campaign: &Campaign) -> Result<Asked, Failure> {
        let (program, shards) = (this_program()?, campaign.plan().shards());
        let tasks = self.tasks.min(shards);
        let script = place.join("slurm.sh");
        output::write(&script, array_script(&program, place, shards, tasks))?;
        let array = sbatch(&[script.as_os_str().to_string_lossy().as_ref()], &script)?;
        let merge = format!("{program} campaign merge --out {}", word(place));
        let behind = format!("--dependency=afterok:{array}");
        let log = format!("--output={}", place.join("slurm-merge.log").display());
        // A task that failed for good leaves no merge waiting for ever.
        let options = [&behind, "--kill-on-invalid-dep=yes", "--job-name=fspid-merge", &log];
        let merged = sbatch(&[&options[..], &["--wrap", &merge]].concat(), &script)?;
        let told = format!(
            "{} tasks of Slurm fly {shards} shards as job {array}; job {merged} merges them into {}\n",
            tasks,
            place.join("campaign.parquet").display()
        );
        let json = json!({ "schema": 1, "script": script, "array": array, "merge": merged, "tasks": tasks, "shards": shards });
        Ok(Asked::Given(told, json))
    }

    /// As a line for each shard, for whoever runs lines.
    fn listed(&self, place: &Path, folder: &Folder, campaign: &Campaign) -> Result<Asked, Failure> {
        let program = this_program()?;
        let line = |number: u64| {
            format!("{program} campaign shard {number} --threads 1 --quiet --out {}", word(place))
        };
        let lines: Vec<String> = shard::missing(folder, campaign).into_iter().map(line).collect();
        let manifest = place.join("kubernetes.yaml");
        output::write(&manifest, kubernetes(&self.image, campaign.plan().shards()))?;
        note(format_args!(
            "wrote {}; when all lines are done: {program} campaign merge --out {}",
            manifest.display(),
            word(place)
        ));
        let told = lines.iter().map(|line| format!("{line}\n")).collect();
        Ok(Asked::Given(told, json!({ "schema": 1, "commands": lines, "manifest": manifest })))
    }
}

fn word(path: &Path) -> String {
    shell::word(&path.display().to_string())
}

/// This program, as a shell on another machine that sees the same disks starts it.
fn this_program() -> Result<String, Failure> {
    let path: PathBuf = std::env::current_exe().map_err(Failure::output)?;
    Ok(word(&path))
}

/// Each task flies every `tasks`-th shard, so that all have as much to do; one that is begun again finds what is there.
fn array_script(program: &str, place: &Path, shards: u64, tasks: u64) -> String {
    let (last, out) = (tasks - 1, word(place));
    let log = place.join("slurm-%a.log");
    let log = log.display();
    format!(
        "#!/bin/sh\n\
         #SBATCH --job-name=fspid\n\
         #SBATCH --array=0-{last}\n\
         #SBATCH --cpus-per-task=1\n\
         #SBATCH --requeue\n\
         #SBATCH --output={log}\n\
         set -eu\n\
         shard=\"$SLURM_ARRAY_TASK_ID\"\n\
         while [ \"$shard\" -lt {shards} ]; do\n    \
             {program} campaign shard \"$shard\" --threads 1 --quiet --out {out}\n    \
             shard=$((shard + {tasks}))\n\
         done\n"
    )
}

/// Gives a script to Slurm; the number of its job.
fn sbatch(arguments: &[&str], script: &Path) -> Result<String, Failure> {
    let asked = Command::new("sbatch").arg("--parsable").args(arguments).output();
    let answer = asked.map_err(|error| match error.kind() {
        ErrorKind::NotFound => Failure::input(format_args!(
            "there is no Slurm here: sbatch is not found; the script is {}, for a machine that has it",
            script.display()
        )),
        _ => Failure::input(format_args!("sbatch: {error}")),
    })?;
    if !answer.status.success() {
        let told = String::from_utf8_lossy(&answer.stderr).trim().to_owned();
        return Err(Failure::input(format_args!("Slurm refused {}: {told}", script.display())));
    }
    let told = String::from_utf8_lossy(&answer.stdout);
    // The cluster's name may stand behind the number.
    Ok(told.trim().split(';').next().unwrap_or_default().to_owned())
}

/// A job with an index for each shard; the campaign's folder is a volume that all pods see.
fn kubernetes(image: &str, shards: u64) -> String {
    format!(
        "apiVersion: batch/v1\n\
         kind: Job\n\
         metadata:\n  \
           name: fspid\n\
         spec:\n  \
           completionMode: Indexed\n  \
           completions: {shards}\n  \
           parallelism: {parallel}\n  \
           backoffLimitPerIndex: 10\n  \
           template:\n    \
             spec:\n      \
               restartPolicy: Never\n      \
               containers:\n        \
                 - name: shard\n          \
                   image: {image}\n          \
                   command: [\"sh\", \"-c\", \"fspid campaign shard $JOB_COMPLETION_INDEX --threads 1 --quiet --out /campaign\"]\n          \
                   resources:\n            \
                     requests: {{ cpu: \"1\" }}\n          \
                   volumeMounts:\n            \
                     - {{ name: campaign, mountPath: /campaign }}\n      \
               volumes:\n        \
                 - name: campaign\n          \
                   persistentVolumeClaim: {{ claimName: fspid-campaign }}\n",
        parallel = shards.min(PODS),
        image = json!(image),
    )
}

/// Pods at a time, unless somebody writes another number.
const PODS: u64 = 100;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tasks_of_an_array_fly_every_shard_once() {
        let script = array_script("fspid", Path::new("/a b"), 10, 3);
        assert!(script.contains("#SBATCH --array=0-2\n"), "{script}");
        assert!(script.contains("--out '/a b'"), "{script}");
        let folder = tempfile::tempdir().expect("a folder");
        let list = folder.path().join("list");
        // A program that writes down which shard it is asked for.
        let program = format!("printf '%s\\n' >> {} #", word(&list));
        let noting = array_script(&program, Path::new("/c"), 10, 3).replace(" #", " \"$shard\" #");
        for task in 0..3 {
            let mut shell = Command::new("sh");
            shell.args(["-c", &noting]).env("SLURM_ARRAY_TASK_ID", task.to_string());
            let status = shell.status().expect("a shell");
            assert!(status.success());
        }
        let mut flown: Vec<u64> = std::fs::read_to_string(list)
            .expect("the list")
            .lines()
            .map(|line| line.parse().expect("a number"))
            .collect();
        flown.sort_unstable();
        assert_eq!(flown, (0..10).collect::<Vec<_>>());
    }

    #[test]
    fn an_image_with_odd_signs_is_still_one_text_of_the_manifest() {
        assert!(kubernetes("a\"b: c", 4).contains("image: \"a\\\"b: c\"\n"));
    }
}
