// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/server/server_options.hpp"

#include "base/input_error.hpp"
#include "haptic_bridge/devices/open_device.hpp"
#include "host/command_line.hpp"

namespace haptic_bridge {

void ServerOptions::addTo(host::CommandLine& line) {
    line.option("--scene", scene, "scene file, the same as the wall's").required();
    line.option("--device", device, "script:gis, script:FILE, trace:FILE.csv, driver:FILE.so, sim:PRESET or spacenav")
        .beginnings({"script:", "trace:", "driver:", "sim:", "spacenav", "spacenav:"})
        .required();
    line.option("--map", map, "mapping from the device to the scene; docs/devices.md")
        .metavar("KEY=VALUE")
        .oneValueEach()
        .offeredBy({"run"});
    line.choice("--pace", pace, "fast: a virtual clock that runs as fast as the wall; not for driver: and spacenav")
        .offeredBy({"run"});
    line.option("--record", record, "file to write with every tick of the device and its force; docs/forces.md")
        .metavar("FILE.csv")
        .offeredBy({"run"});
    line.choice<bool>(
            "--force", force, {{"on", true}, {"off", false}},
            "whether an arm feels a force. With `run` it holds until `ctl force` sets a share; with --resume it "
            "replaces the share that `ctl` had set. A server that you start takes it as a ceiling; docs/devices.md")
        .offeredBy({"run"});
    line.option("--force-scale", forceScale,
                "0 to 1: the share of the force that an arm feels, in the same way as --force")
        .metavar("SHARE")
        .range(0.0, 1.0)
        .offeredBy({"run"});
    line.flag("--force-until-ctl", forceUntilCtl,
              "--force and --force-scale hold until `ctl force` sets a share, as for the server of `sandwall run`; "
              "without it they are a ceiling; docs/devices.md");
    line.choice<Guards::Mode>(
            "--guards", guards, {{"on", Guards::Mode::on}, {"literal", Guards::Mode::literal}},
            "literal: the law as its paper prints it, without force limits, for simulated arms only; not for driver: "
            "and spacenav; docs/forces.md")
        .offeredBy({"run"});
    line.option("--listen", listen, "ADDRESS:PORT; port 0 takes any free one");
    line.option("--port-file", portFile, "file that gets the port's number when a master can be linked");
    line.option("--listening-file", listeningFile,
                "file that gets the port's number when the server listens, before it has read its scene");
    line.option("--scene-error-file", sceneErrorFile,
                "file that gets the line about an error in the scene, in place of standard error");
    line.option("--timings", timings,
                "CSV file for histograms at the end: period of the force loop and time for each force");
    line.option("--timing-tests", tests.perSecond,
                "timing tests a second, at random times (default: 4; docs/latency.md)")
        .range(0.1, 100.0);
    line.option("--timing-after", tests.after, "[s] from the start of a link to its first timing test (default: 0)")
        .range(0.0, 3600.0);
    line.option("--timing-seed", tests.seed, "seed of the random times (default: 7)");
    link.addTo(line, true);
    host::addSandThreads(line, sandThreads).offeredBy({"run"});
    line.flag("--die-with-parent", endWithParent, "end in order when the program that started this one ends");
}

void ServerOptions::checkRealDevice() const {
    if (isRealDevice(device) && pace == Pace::fast) {
        throw base::InputError(
            "--pace fast: drives a virtual clock, which a real device cannot follow; use it with script:, trace: or "
            "sim:, or give --pace realtime");
    }
    if (isRealDevice(device) && guards == Guards::Mode::literal) {
        throw base::InputError(
            "--guards literal: sends the law without limits, which only a simulated arm may get; use it with sim:, or "
            "give --guards on");
    }
}

}  // namespace haptic_bridge
