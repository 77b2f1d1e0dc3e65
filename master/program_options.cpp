// SPDX-License-Identifier: Apache-2.0
#include "master/program_options.hpp"

#include "host/command_line.hpp"

namespace master {
namespace {

void describeSession(host::CommandLine& line, ProgramOptions& options) {
    SessionOptions& session = options.session;
    line.option("--scene", options.scene, "scene file").metavar("FILE");
    line.option("--wall", options.wall, "wall file").metavar("FILE").required();
    line.option("--out", options.out, "folder for journal, pictures and summary").metavar("FOLDER").required();
    line.option("--haptic", options.haptic, "address of the haptic server, or none").metavar("HOST:PORT").showDefault();
    options.link.addTo(line, false);
    line.flag("--pointer", session.pointer, "the hand is the pointer of the ranks' windows (docs/pointer.md)");
    line.flag("--visible-tool", session.desk.visibleTool,
              "begin with a tool that is large enough to be seen, if that of the scene is smaller (docs/pointer.md)")
        .offeredBy({"run"});
    line.choice(
            "--pace", session.pace,
            "fast: as fast as the machine can, and a recorded hand waits for the wall; not for driver: and spacenav")
        .offeredBy({"run"});
    const host::Option steps = line.option("--steps", session.steps,
                                           "end after exactly this many shown steps, with those that only pay sweeps")
                                   .metavar("N")
                                   .positive();
    steps.offeredBy({"run"});
    line.option("--frames", session.frames, "end after this many frames")
        .metavar("N")
        .positive()
        .excludes(steps)
        .offeredBy({"run"});
    line.option("--warm-up", session.settlingFrames, "number of first frames whose times do not count")
        .metavar("FRAMES")
        .range(0, 1000000)
        .offeredBy({"run"});
    line.option("--frame-timeout", session.frameTimeout, "seconds a frame may take before the job ends")
        .metavar("SECONDS")
        .range(2.0, 3600.0)
        .showDefault()
        .offeredBy({"run", "film"});
    host::addSandThreads(line, options.sandThreads).offeredBy({"run", "film"});
    line.flag("--no-pictures", options.noPictures, "write no pictures at the end").offeredBy({"run"});
    line.flag("--no-report", options.noReport, "print no figures at the end, because another program prints them");
    line.flag("--control-stdin", session.desk.readInput,
              "read commands from standard input (docs/operator.md); its end stops the session, before the first frame "
              "at once");
    line.option("--place", options.places,
                "RANK,RANK=HOST=MACHINE: machine on which these ranks must run, from the launcher (docs/hosts.md)");
    line.option("--inject", options.injections, "drill, such as slow:rank=5,ms=30; docs/operator.md")
        .metavar("KIND:KEY=N,…")
        .offeredBy({"run"});
}

void describeView(host::CommandLine& line, ProgramOptions& options) {
    line.option("--refresh", options.session.refreshHz, "frames per second, in place of the wall file's")
        .metavar("HZ")
        .range(1.0, 1000.0)
        .offeredBy({"run"});
    line.option("--stereo", options.stereo, "stereo mode, in place of the wall file's; docs/wall_files.md")
        .metavar("MODE")
        .offeredBy({"run", "film"});
    line.option("--desk", options.desk,
                "area of this desktop on which the whole wall is shown with one eye, in windows; docs/pointer.md")
        .metavar("WIDTHxHEIGHT+X+Y")
        .excludes(line.named("--stereo"))
        .offeredBy({"run"});
    line.option("--track", options.track,
                "tracker of the head: trace:FILE.csv, opentrack:PORT, dtrack:PORT or none; docs/head_tracking.md")
        .metavar("SOURCE")
        .offeredBy({"run", "film"});
    line.option("--pattern", options.pattern, "a test pattern instead of the sand; docs/test_patterns.md")
        .metavar("NAME")
        .offeredBy({"run"});
    line.option("--show", options.layers,
                "layer beside the sand: wireframe, hill-shade, force, statistics or help; docs/operator.md")
        .metavar("LAYER")
        .offeredBy({"run"});
}

void describeResume(host::CommandLine& line, ProgramOptions& options) {
    const host::Option resume = line.flag("--resume", options.resume, "continue the session in --out, if there is one");
    resume.excludes(line.named("--replay"));
    Failure& failure = options.session.record.failure;
    const host::Option at = line.option("--failed-at", failure.noticed,
                                        "time at which the failure was noticed, by the steady clock of --failed-on");
    at.metavar("SECONDS").notNegative().needs(resume);
    line.option("--failed-on", failure.machine,
                "machine of that clock: NAME/BOOT_ID; on another one, --failed-before counts")
        .metavar("MACHINE")
        .needs(at);
    line.option("--failed-before", failure.before, "time from the failure to the start of this job")
        .metavar("SECONDS")
        .notNegative()
        .needs(resume);
    line.choice("--journal", options.session.record.journal.policy,
                "required: show only steps that are on disk; best-effort: continue without a journal; docs/journal.md")
        .offeredBy({"run"});
    line.option("--checkpoint", options.session.record.journal.checkpointSeconds,
                "time between two checkpoints, 0 for none; docs/journal.md")
        .metavar("SECONDS")
        .range(0.0, 86400.0)
        .offeredBy({"run"});
    line.option("--journal-part", options.partMegabytes, "MiB after which the journal continues in another file")
        .range(1, 1 << 20);
    line.option("--force-share", options.session.forceShare,
                "0 to 1: share of its force that the hand feels, as an operator sets it; wins over the journal")
        .range(0.0, 1.0)
        .excludes(line.named("--replay"));
    line.option("--failure", failure.what, "text about the failure; written to the journal and to recoveries.jsonl")
        .needs(resume);
    line.option("--failed-rank", failure.rank, "rank that failed; leave it out if no rank failed").needs(resume);
    line.option("--failed-how", failure.how, "how it failed: a signal's name, 'status N', hung, broken or disk")
        .needs(resume);
}

void describeReplay(host::CommandLine& line, ProgramOptions& options) {
    const host::Option replay =
        line.option("--replay", options.replay, "journal of a session, or its folder, shown again instead of a scene");
    for (const char* other : {"--scene", "--haptic", "--pointer", "--refresh"}) {
        replay.excludes(line.named(other));
    }
    line.option("--fps", options.framesPerSecond, "frames per second of the replay")
        .metavar("N")
        .range(1, 240)
        .showDefault()
        .needs(replay)
        .offeredBy({"film"});
    const host::Option film =
        line.flag("--film", options.session.film, "write every frame of a replay as a picture of the whole wall");
    film.needs(replay);
    line.option("--from", options.span.from, "the film begins behind this step of the session (default: 0, its start)")
        .metavar("STEP")
        .needs(film)
        .offeredBy({"film"});
    line.option("--to", options.span.to, "the film ends at this step of the session (default: its last one)")
        .metavar("STEP")
        .positive()
        .needs(film)
        .offeredBy({"film"});
    line.option("--view", options.view, "the film shows a desktop's sand from here, as F9 has printed it")
        .metavar("ZOOM,TURN,TILT,EAST,NORTH,UP")
        .needs(film)
        .offeredBy({"film"});
    line.choice("--eye", options.session.filmEye, "the eye that the film shows, in any stereo mode")
        .needs(film)
        .offeredBy({"film"});
}

}  // namespace

void ProgramOptions::addTo(host::CommandLine& line) {
    describeSession(line, *this);
    describeView(line, *this);
    describeReplay(line, *this);
    describeResume(line, *this);
}

}  // namespace master
