# SPDX-License-Identifier: Apache-2.0
"""All that the launcher knows about mpirun: the options and the output of Open MPI 4.1 and of Open MPI 5 (docs/hosts.md).

The machine of the launcher decides at run time, because on a cluster the mpirun there counts and not that of the build.
"""

import contextlib
import dataclasses
import glob
import itertools
import os
import pathlib
import re
import shlex
import shutil
import socket
import stat
import subprocess
import tempfile

from base.bad_input import BadInput
from job.rank_hosts import HERE, is_address

SUPPORTED = "Sandwall supports Open MPI 4.1 and 5"
ANSWER_SECONDS = 20
CONNECT_SECONDS = 20  # for a connection of ssh; a host that is off does not refuse it
VERSION = re.compile(r"^mpirun \(Open MPI\) (([0-9]{1,4})\.([0-9]{1,4})\S{0,40})$", re.MULTILINE)
AGENTS = ("OMPI_MCA_plm_rsh_agent", "PRTE_MCA_plm_ssh_agent")  # each names a program in place of ssh
# The launcher chooses the hosts. mpirun must not take them from the defaults of a user's or a site's Open MPI. In a shell of
# salloc or Grid Engine, it must not take them from the scheduler.
OWN_HOSTS_4 = {"orte_default_hostfile": "none", "orte_default_dash_host": "none", "ras": "^slurm,gridengine,tm,loadleveler,lsf,alps",
               "plm": "^slurm,tm,lsf,alps", "plm_rsh_disable_qrsh": "1", "plm_rsh_disable_llspawn": "1"}
OWN_HOSTS_5 = {"PRTE_MCA_prte_default_hostfile": "none", "PRTE_MCA_prte_default_dash_host": "none"}
IN_SCHEDULERS_JOB_5 = {"PRTE_MCA_plm": "ssh", "PRTE_MCA_ras": "^slurm,pbs,lsf,gridengine,flux"}
SCHEDULERS = ("SLURM_JOB_ID", "SLURM_JOBID", "PBS_JOBID", "LSB_JOBID", "PE_HOSTFILE", "FLUX_JOB_ID")  # variables of a scheduler's job
# Variables of a process that mpirun has started. mpirun refuses to start another mpirun there.
IN_A_JOB = ("OMPI_UNIVERSE_SIZE", "OMPI_COMM_WORLD_RANK")
RANK = "PMIX_RANK"  # Open MPI 5 sets it for every process before the process begins
JOB_ID = b"OMPI_MCA_ess_base_jobid="  # begins an entry in the environment of a rank of Open MPI 4.1
SHARED_MEMORY = "/dev/shm"
RELAY = "SANDWALL_RELAY"  # descriptor to which a rank writes what must reach the launcher; with _LOST, what its file does not take (host/rank_output.hpp)
RANK_LOG = "SANDWALL_RANK_LOG"  # the file of a rank's output, for a rank that the launcher cannot read


@dataclasses.dataclass
class Job:
    """One job of mpirun: the master on this machine, and a render rank per tile on its host."""

    master: list  # words of its command
    node: list
    hosts: list  # of the render ranks in their order; this machine is HERE
    network: str = None  # between the hosts, such as 10.0.0.0/24
    variables: list = dataclasses.field(default_factory=list)  # for every rank: NAME, or NAME=VALUE that all users may read
    output: str = None  # beginning of the names of the files that keep the output; None: it is not kept
    hosts_path: str = None  # path of the file with the lines of hosts_file()

    def here(self):
        return all(host == HERE for host in self.hosts)


class OpenMpi4:
    """Open MPI 4.1, whose runtime is ORTE. The output of all ranks comes through mpirun, with a tag before each piece."""

    tag = re.compile(rb"\[\d+,(\d{1,9})\]<std(?:out|err)>:")  # mpirun --tag-output writes it before every piece of a rank's output
    cut_tag = re.compile(rb"\[[\d,]{0,12}\]?(?:<[a-z]{0,6}>?)?$")  # what may be the beginning of a tag, at the end of a piece
    # Lines that mpirun -q would not have printed.
    own = re.compile(rb"\[[\w.-]+:\d+\]|mpirun: ")
    signalled = re.compile(rb"process rank (\d{1,9}) with PID \d+ on node (\S+) exited on\s+signal (\d{1,9})")
    exited = re.compile(rb"Process name: \[\[\d+,\d+\],(\d{1,9})\]\s+Exit code:\s+(\d{1,9})")
    keeps_output = False  # a job whose output is not kept prints it as it comes

    def __init__(self, version):
        self.version = version

    def command(self, job):
        # -q, because our own line reports the failure. With tags, the launcher also reads mpirun's lines about ended ranks.
        # Then mpirun prints which signal ended which rank.
        output = ["-q"] if job.output is None else ["--tag-output"]
        # A job that ends by signals has nothing to keep. By default mpirun waits a second before it kills the last processes.
        at_once = ["--mca", "odls_base_sigkill_timeout", "0"]
        own_hosts = [word for name, value in OWN_HOSTS_4.items() for word in ("--mca", name, value)]
        return ["mpirun", *output, "--oversubscribe", "--bind-to", "none", *at_once, *own_hosts, *self.transport(job), *passed_on(job), *self.programs(job)]

    def transport(self, job):
        """Returns the options for communication: shared memory within a host, TCP between hosts."""
        if job.here():
            # The ranks do not listen for connections. mpirun itself still listens on all addresses (docs/how_it_works.md).
            return ["--mca", "btl", "self,vader", "--mca", "oob_tcp_if_include", "lo"]
        network = [] if job.network is None else ["--mca", "btl_tcp_if_include", job.network,
                                                  "--mca", "oob_tcp_if_include", job.network]
        # Otherwise Open MPI cuts names at the first dot, and starts the ranks of node.1.org and node.2.org on one machine.
        return ["--mca", "btl", "self,vader,tcp", "--mca", "orte_keep_fqdn_hostnames", "1", *network, *BETWEEN_HOSTS]

    def programs(self, job):
        """Returns the programs: the master here, then one group of render ranks for each change of host.

        mpirun numbers ranks program by program. So rank r is on the r-th host of the list.
        """
        if job.here():
            return ["-n", "1", *job.master, ":", "-n", str(len(job.hosts)), *job.node]
        words = ["-n", "1", "--host", HERE, *job.master]
        for host, run in itertools.groupby(job.hosts):
            count = len(list(run))
            words += [":", "-n", str(count), "--host", f"{host}:{count}", *job.node]
        return words

    def hosts_file(self, job):
        """Returns the text of the file of hosts that command() needs at Job.hosts_path, or None."""
        return None

    def variables(self, environment):
        """Returns the variables for mpirun itself that a job needs in this environment."""
        return {}

    def tidy(self, pid):
        """Removes what the mpirun with this process id has left behind: its folder, if it was killed, or ended by a signal at its start."""
        host = glob.escape(socket.gethostname().partition(".")[0])
        for name in (host, f"{host}.*"):  # with or without a domain
            remove_folders(os.path.join(f"ompi.{name}.{os.geteuid()}", f"pid.{int(pid)}"))


class OpenMpi5:
    """Open MPI 5, whose runtime is PRRTE.

    It numbers the ranks of several programs host by host, so it starts one program, which becomes master or render rank by
    its rank. Its mpirun mixes bursts of lines of different ranks. So each rank writes its output into a file, and only short
    lines with a checksum come through mpirun from ranks on other hosts.
    """

    tag = re.compile(rb"\[\d+,(\d{1,9})\]<std(?:out|err)>: ?")
    cut_tag = re.compile(rb"\[[\d,]{0,12}\]?(?:<[a-z]{0,6}>?:?)?$")
    own = re.compile(rb"\[[\w.-]+:\d+\]|mpirun: |prterun: |plm:ssh: |\0")
    signalled = OpenMpi4.signalled
    exited = re.compile(rb"Process name: \[[^\s\]]{1,300}@\d{1,9},(\d{1,9})\]\s+Exit code:\s+(\d{1,9})")
    keeps_output = True  # always, because mpirun has no option that hides its banner

    def __init__(self, version):
        self.version = version

    def command(self, job):
        place = ["--oversubscribe"] if job.here() else ["--hostfile", job.hosts_path, "--map-by", "seq:OVERSUBSCRIBE"]
        tags = [] if job.output is None else ["--tag-output"]
        return ["mpirun", *tags, "--bind-to", "none", *self.transport(job), *passed_on(job), *place,
                "-n", str(1 + len(job.hosts)), "sh", "-c", self.script(job)]

    def transport(self, job):
        if job.here():
            # PMIx, through which ranks and mpirun find each other, then listens at 127.0.0.1.
            return ["--mca", "btl", "self,sm", "--pmixmca", "ptl_tcp_if_include", "lo"]
        network = []
        if job.network is not None:
            network = ["--mca", "btl_tcp_if_include", job.network, "--prtemca", "prte_if_include", job.network,
                       "--pmixmca", "ptl_tcp_if_include", job.network]
        return ["--mca", "btl", "self,sm,tcp", *network, *BETWEEN_HOSTS]

    def script(self, job):
        """Returns the program of all ranks, for sh. With exec, the process stays the child of mpirun's daemon.

        The launcher has made the files of the ranks on this machine. A rank without such a file makes one in its folder for
        temporary files, which only its user can read. mktemp follows no link. Descriptor 9 stays open in every rank, because
        mpirun ends the input of a rank that has closed both of its outputs.
        """
        begin = f'if [ "${RANK}" = 0 ]; then exec {shlex.join(job.master)}; else exec {shlex.join(job.node)}; fi'
        if job.output is None:
            return begin
        return (f'exec 9>&2; log={shlex.quote(job.output)}.rank_${RANK}; if [ -w "$log.err" ]; then exec >>"$log.out" 2>>"$log.err"; export {RELAY}_LOST=9; else '
                f'export {RELAY}=9; umask 077; if log=$(mktemp "${{TMPDIR:-/tmp}}/sandwall-rank-${RANK}.XXXXXX"); '
                f'then export {RANK_LOG}="$log"; else log=/dev/null; fi; umask {current_umask():03o}; exec >>"$log" 2>&1; fi; {begin}')

    def hosts_file(self, job):
        if job.here():
            return None
        self.require_different_names(job.hosts)
        return "".join(f"{host}\n" for host in [HERE, *job.hosts])

    def require_different_names(self, hosts):
        """Throws BadInput if two hosts have the same name up to the first dot. mpirun would take them for one machine.

        Tried with 5.0.7: its option prte_keep_fqdn_hostnames changes nothing.
        """
        known = {}
        for host in hosts:
            if not is_address(host) and known.setdefault(host.partition(".")[0], host) != host:
                raise BadInput(f"{known[host.partition('.')[0]]}, {host}: mpirun (Open MPI) {self.version} takes hosts with the same name "
                               "up to the first dot for one machine; write addresses in the list of hosts; docs/hosts.md")

    def variables(self, environment):
        """Passes the program in place of ssh on under the name that Open MPI 5 reads."""
        agent = environment.get(AGENTS[1]) or environment.get(AGENTS[0])
        in_job = any(environment.get(name) for name in SCHEDULERS)
        return {**OWN_HOSTS_5, **(IN_SCHEDULERS_JOB_5 if in_job else {}), **({AGENTS[1]: agent} if agent else {})}

    def tidy(self, pid):
        """After a job that failed, prterun leaves its folder in the folder for temporary files."""
        remove_folders(f"prterun.*.{int(pid)}.*")


def remove_folders(pattern):
    """Removes the folders of this user in the folder for temporary files whose path matches `pattern`. Follows no link."""
    base = tempfile.gettempdir()
    for folder in glob.glob(os.path.join(glob.escape(base), pattern)):
        above = os.path.dirname(folder)
        if is_own_folder(folder) and (above == base or is_own_folder(above)):
            shutil.rmtree(folder, ignore_errors=True)
            if above != base:
                with contextlib.suppress(OSError):  # another job has its folder there
                    os.rmdir(above)


def is_own_folder(path):
    try:
        about = os.lstat(path)
    except OSError:
        return False  # another job has removed it
    return stat.S_ISDIR(about.st_mode) and about.st_uid == os.geteuid()


def tidy_after(pid, job_id=None):
    """Removes what an mpirun of any version with this process id has left behind, and the memory of its job `job_id`."""
    for kind in (OpenMpi4, OpenMpi5):
        kind("").tidy(pid)
    forget_memory(job_id)


def job_id_of(rank):
    """Returns the id of the job of the process `rank`, as in the names of its shared memory. Returns None for other processes."""
    try:
        entries = pathlib.Path("/proc", str(rank), "environ").read_bytes().split(b"\0")
    except OSError:
        return None  # it has ended
    return next((f"{int(entry[len(JOB_ID):]):x}" for entry in entries if entry.startswith(JOB_ID) and entry[len(JOB_ID):].isdigit()), None)


def forget_memory(job_id):
    """Removes the shared memory of an ended job on this machine. An mpirun that was killed leaves it. `job_id` may be None."""
    for path in glob.glob(f"{SHARED_MEMORY}/vader_segment.*.{os.geteuid()}.{job_id}.*") if job_id else ():
        with contextlib.suppress(OSError):
            about = os.lstat(path)
            if stat.S_ISREG(about.st_mode) and about.st_uid == os.geteuid():
                os.unlink(path)


# Open MPI sends a variable of this machine's environment to the other hosts only with -x.
BETWEEN_HOSTS = ["--mca", "mpi_yield_when_idle", "1", "-x", "LP_NUM_THREADS", "-x", "HWLOC_COMPONENTS"]


def passed_on(job):
    """Returns the options that give the job's variables to every rank, each of them once."""
    words, given = [], set(BETWEEN_HOSTS if not job.here() else [])
    for word in job.variables:
        name = word.partition("=")[0]
        if name not in given:
            given.add(name)
            words += ["-x", word]
    return words


def current_umask():
    mask = os.umask(0o077)
    os.umask(mask)
    return mask


def kind_of(said):
    """Returns OpenMpi4 or OpenMpi5 for the output of `mpirun --version`. Throws BadInput for all else."""
    found = VERSION.search(said)
    if not found:
        first = (said.strip().split("\n") or [""])[0][:80]
        raise BadInput(f"mpirun: `mpirun --version` prints '{first}'; {SUPPORTED}: install openmpi-bin, or put its mpirun first in PATH")
    major, minor = int(found[2]), int(found[3])
    if (major, minor) == (4, 1):
        return OpenMpi4(found[1])
    if major == 5:
        return OpenMpi5(found[1])
    raise BadInput(f"mpirun: is of Open MPI {found[1]}; {SUPPORTED}")


class Question:
    """`mpirun --version`, which runs while the launcher does other work."""

    def __init__(self):
        """Throws BadInput in a job of mpirun, where no other mpirun can run."""
        if inside := next((name for name in IN_A_JOB if name in os.environ), None):
            raise BadInput(f"{inside}: is set, because mpirun has started this command, and Open MPI starts no mpirun from another; "
                           "leave out the mpirun before it, because sandwall starts its own")
        self.kind = None
        # Standard error too, because MPICH's mpirun complains there.
        self.process = subprocess.Popen(["mpirun", "--version"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                        stderr=subprocess.STDOUT, text=True, errors="replace")

    def answer(self):
        if self.kind is None:
            try:
                said = self.process.communicate(timeout=ANSWER_SECONDS)[0]
            except subprocess.TimeoutExpired as error:
                self.process.kill()
                self.process.communicate()
                raise BadInput(f"mpirun: does not answer --version within {ANSWER_SECONDS} s; {SUPPORTED}") from error
            self.kind = kind_of(said)
        return self.kind


def remote_shell(environment=os.environ):
    """Returns the command that mpirun starts its daemons with, as a list of words.

    The variable may name several commands, separated by colons; this is the first.
    """
    given = next((environment[name] for name in AGENTS if environment.get(name)), "")
    words = shlex.split(given.split(":")[0]) or ["ssh", "-o", "BatchMode=yes"]
    return [*words, "-o", f"ConnectTimeout={CONNECT_SECONDS}"] if words[0] == "ssh" else words
