#!/usr/bin/python3
"""A study whose runs are jobs of a real Slurm: its daemons run here, on this one node, with folders, ports and a key of
their own, as ordinary processes that end with the test. Skipped without Debian's slurmctld, slurmd, slurm-client and
munge, and for others than root, whose jobs slurmd could not start.

usage: slurm_study.py MPMFAST SOURCE_DIR
"""
import json
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

program = os.path.abspath(sys.argv[1])
os.environ["PATH"] += ":/usr/sbin:/sbin"
PROGRAMS = ["munged", "slurmctld", "slurmd", "srun", "scontrol", "scancel", "squeue", "sinfo"]
PATIENCE = 300  # s, of a machine that others use too

missing = [name for name in PROGRAMS if not shutil.which(name)]
if missing or os.geteuid() != 0:
    print(f"no Slurm to test with: {'not root' if not missing else 'missing: ' + ', '.join(missing)}")
    sys.exit(77)

CONFIGURATION = """\
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_min_interval=100000,batch_sched_delay=0
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
ReturnToService=2
SlurmdParameters=config_overrides
KillWait=30
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 RealMemory=1000
PartitionName=main Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""

SCENE = """\
title: a block that swings
space: plane_strain
grid: {size: [20 mm, 20 mm], cell: 0.25 mm}
time: {end: 400 us}
materials: {rubber: {model: neo_hookean, density: 1.2 g/cm^3, young: 80 MPa, poisson: 0.33}}
bodies:
  - {name: block, box: {from: [4 mm, 4 mm], to: [16 mm, 12 mm]}, material: rubber, velocity: [0, -10 m/s]}
boundaries: {bottom: wall}
output: {frames: 2, history: 20, checkpoint: {steps: 100}}
"""

STUDY = """\
scene: scene.yaml
variants:
  - {name: killed}
  - {name: cancelled, set: {time.cfl: 0.35}}
  - {name: queued, set: {time.cfl: 0.3}}
quantities: {kinetic: kinetic_J}
"""


def free_ports(count):
    sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    ports = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return ports


def wait_until(holds, what, patience=PATIENCE):
    until = time.monotonic() + patience
    while not holds():
        if time.monotonic() > until:
            raise AssertionError(f"waited {patience} s in vain: {what}")
        time.sleep(0.05)


def process_of(folder):
    """The run that writes into the folder, not the srun before it."""
    for entry in pathlib.Path("/proc").glob("[0-9]*/cmdline"):
        try:
            words = entry.read_bytes().decode().split("\0")
        except OSError:  # it has ended
            continue
        if words[0] == program and str(folder) in words:
            return int(entry.parent.name)
    raise AssertionError(f"no run in {folder}")


class Slurm:
    """The daemons; every client command finds them by SLURM_CONF."""

    def __init__(self, folder):
        self.folder, self.daemons = folder, []
        self.host = socket.gethostname().split(".")[0]
        for name in ("state", "spool"):
            (folder / name).mkdir()
        key = folder / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o600)
        configuration = CONFIGURATION.format(host=self.host, ports=free_ports(2), folder=folder)
        (folder / "slurm.conf").write_text(configuration)
        self.environment = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf"), "OMP_WAIT_POLICY": "passive"}

    def start(self):
        names = {word: f"{self.folder}/munge.{word}" for word in ("key", "socket", "pid", "log", "seed")}
        self.daemon("munged", "--foreground", "--key-file", names["key"], "--socket", names["socket"], "--pid-file",
                    names["pid"], "--log-file", names["log"], "--seed-file", names["seed"])
        wait_until((self.folder / "munge.socket").exists, f"munged\n{self.said()}", 30)
        self.daemon("slurmctld", "-D")
        self.daemon("slurmd", "-D", "-N", self.host)
        wait_until(lambda: "idle" in self.ask("sinfo", "-h", "-o", "%T"), "an idle node", 60)

    def daemon(self, *words):
        with open(self.folder / f"{words[0]}.out", "wb") as out:
            self.daemons.append(subprocess.Popen(words, env=self.environment, stdout=out, stderr=out,
                                                 stdin=subprocess.DEVNULL))

    def ask(self, *words):
        return subprocess.run(words, env=self.environment, capture_output=True, text=True).stdout

    def jobs(self, *words):
        return self.ask("squeue", "-h", *words).split()

    def said(self):
        return "\n".join(path.read_text(errors="replace")[-2000:] for path in sorted(self.folder.glob("*.out")))

    def stop(self):
        self.ask("scancel", "--signal=KILL", *self.jobs("-o", "%A"))
        self.ask("scancel", *self.jobs("-o", "%A"))
        for _ in range(100):
            if not self.jobs("-o", "%A"):
                break
            time.sleep(0.1)
        for daemon in reversed(self.daemons):
            daemon.terminate()
        for daemon in self.daemons:
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                daemon.kill()


class SlurmStudy(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory(prefix="slurm-study-")
        cls.work = pathlib.Path(cls.place.name)
        cls.work.chmod(0o755)  # munged wants its clients to reach the socket
        cls.slurm = Slurm(cls.work)
        cls.addClassCleanup(cls.place.cleanup)
        cls.addClassCleanup(cls.slurm.stop)
        try:
            cls.slurm.start()
        except AssertionError as failure:
            raise AssertionError(f"{failure}\n{cls.slurm.said()}") from None
        (cls.work / "scene.yaml").write_text(SCENE)
        (cls.work / "study.yaml").write_text(STUDY)
        cls.run_study("here")

    @classmethod
    def study(cls, out, *words):
        """Starts it; its messages go to a file."""
        with open(cls.work / f"{out}.err", "ab") as err:
            return subprocess.Popen([program, "study", "study.yaml", "--out", out, "--progress", "plain", *words],
                                    cwd=cls.work, env=cls.slurm.environment, stdout=subprocess.DEVNULL, stderr=err)

    @classmethod
    def run_study(cls, out, *words):
        code = cls.study(out, *words).wait(PATIENCE)
        assert code == 0, f"exit {code}\n{cls.messages(out)}"

    @classmethod
    def messages(cls, out):
        return (cls.work / f"{out}.err").read_text() + "".join(
            f"--- {path.name}\n{path.read_text()[-1000:]}" for path in sorted((cls.work / out).glob("*.log")))

    def launched(self, out, *words):
        return self.study(out, "--threads", "1", "--launcher", "srun -n1 -c{threads} -J {name}", *words)

    def summary(self, out, name):
        return json.loads((self.work / out / name / "run.json").read_text())

    def is_saved(self, out, name):
        return (self.work / out / name / "checkpoint.h5").exists() and name in self.slurm.jobs("-t", "RUNNING", "-o", "%j")

    def check_same(self, out):
        """The results are those of the study that ran here."""
        for name in ("killed", "cancelled", "queued"):
            with self.subTest(name):
                self.assertEqual(self.summary(out, name)["checksum"], self.summary("here", name)["checksum"])
                files = [self.work / folder / name / "history.csv" for folder in ("here", out)]
                self.assertEqual(files[0].read_bytes(), files[1].read_bytes())

    def test_losses(self):
        """Two runs side by side, the third in Slurm's queue. One is killed as by a machine without memory, one cancelled
        in the queueing system, then the node is lost with all that runs."""
        study = self.launched("lost", "--jobs", "3", "--restarts", "4")
        wait_until(lambda: self.is_saved("lost", "killed"), f"killed runs\n{self.messages('lost')}")
        os.kill(process_of(self.work / "lost" / "killed"), signal.SIGKILL)
        wait_until(lambda: self.is_saved("lost", "cancelled"), f"cancelled runs\n{self.messages('lost')}")
        self.slurm.ask("scancel", "--name", "cancelled")
        wait_until(lambda: self.is_saved("lost", "queued"), f"queued runs\n{self.messages('lost')}")
        node = ["scontrol", "update", f"nodename={self.slurm.host}"]
        self.slurm.ask(*node, "state=down", "reason=test")
        wait_until(lambda: not self.slurm.jobs("-t", "RUNNING", "-o", "%j"), "the node is down")
        self.slurm.ask(*node, "state=resume")
        self.assertEqual(study.wait(PATIENCE), 0, self.messages("lost"))
        said = self.messages("lost")
        self.assertRegex(said, r"killed: exit status 137 \(signal 9\).*; started again from its checkpoint, 1 of 4")
        self.assertIn("cancelled: somebody stopped it; started again from its checkpoint", said)
        self.assertIn("queued: ", said)
        self.assertIn("0 under way, 3 done, 0 failed, 0 to come", said)
        self.check_same("lost")

    def test_stop(self):
        """A signal to the study stops its jobs with a checkpoint and takes the queued one back; then they go on."""
        study = self.launched("stopped", "--jobs", "3")
        wait_until(lambda: self.is_saved("stopped", "killed"), f"a run\n{self.messages('stopped')}")
        study.send_signal(signal.SIGTERM)
        self.assertEqual(study.wait(PATIENCE), 143, self.messages("stopped"))
        wait_until(lambda: not self.slurm.jobs("-o", "%j"), "no job is left", 30)
        self.assertEqual(self.summary("stopped", "killed")["status"], "stopped")
        self.assertEqual(self.launched("stopped", "--jobs", "2").wait(PATIENCE), 0, self.messages("stopped"))
        self.assertEqual(self.summary("stopped", "killed")["resumes"], 1)
        self.check_same("stopped")

    def test_other_node(self):
        """A job that Slurm refuses is told with Slurm's words."""
        study = self.study("refused", "--restarts", "0", "--launcher", "srun -n1 -p nowhere")
        self.assertEqual(study.wait(PATIENCE), 4)
        self.assertIn("lost: exit status 1: srun: error: Unable to allocate resources: Invalid partition name",
                      self.messages("refused"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
