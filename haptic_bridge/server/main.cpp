// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <utility>

#include "base/input_error.hpp"
#include "haptic_bridge/devices/driver.hpp"
#include "haptic_bridge/devices/open_device.hpp"
#include "haptic_bridge/hand/device_troubles.hpp"
#include "haptic_bridge/link/link_options.hpp"
#include "haptic_bridge/loop/force_loop.hpp"
#include "haptic_bridge/loop/tick_recorder.hpp"
#include "haptic_bridge/server/end_signals.hpp"
#include "haptic_bridge/server/force_ceiling.hpp"
#include "haptic_bridge/server/listen_at.hpp"
#include "haptic_bridge/server/listener.hpp"
#include "haptic_bridge/server/loading_answers.hpp"
#include "haptic_bridge/server/parent_watch.hpp"
#include "haptic_bridge/server/server_options.hpp"
#include "haptic_bridge/server/timings.hpp"
#include "host/clock.hpp"
#include "host/command_line.hpp"
#include "host/event.hpp"
#include "host/memory.hpp"
#include "host/phase_progress.hpp"
#include "host/version.hpp"
#include "host/whole_file.hpp"
#include "host/worker_pool.hpp"
#include "sand/model/grid_codec.hpp"
#include "scene/load/memory.hpp"

namespace {

namespace asio = boost::asio;
using boost::system::error_code;
using namespace haptic_bridge;

constexpr double kScene = 0.8;  // part of the time to the first answer that the scene takes; its replica takes the rest

void print(const std::string& line) {
    std::fprintf(stderr, "sandwall-haptic-server: %s\n", line.c_str());
    std::fflush(stderr);
}

Report measured(const HapticTick& hand, const ForceLoop* loop, const SandThread& sandThread) {
    Report report;
    if (loop != nullptr) {
        report.hapticPeriodUsP50 = loop->period().percentileNs(0.50) * 1e-3;
        report.hapticPeriodUsP99 = loop->period().percentileNs(0.99) * 1e-3;
        report.hapticPeriodUsMax = loop->period().maxNs() * 1e-3;
        report.ticks = loop->period().count();
        report.ticksMissed = loop->missed();
    }
    report.forceUsP50 = hand.forceCost().percentileNs(0.50) * 1e-3;
    report.forceUsP99 = hand.forceCost().percentileNs(0.99) * 1e-3;
    report.stepsWithheld = sandThread.withheld();
    report.samplesDropped = sandThread.dropped();
    report.guards = hand.guardCounts().all();
    report.handTicks = hand.handTicks().all();
    report.feltTicks = hand.handTicks().felt();
    report.faultedTicks = hand.handTicks().faulted();
    report.handSeconds = hand.handTicks().seconds();
    report.faultedSeconds = hand.handTicks().faultedSeconds();
    report.asked = hand.handTicks().asked();
    report.literal = hand.guards().mode() == Guards::Mode::literal;
    if (const TroubleCounts* troubles = hand.device().troubles()) {
        report.deviceLosses = troubles->losses();
        report.deviceAway = troubles->away();
    }
    report.arm = hand.device().physics() != nullptr;
    return report;
}

/// Prints what the device does wrong, and that the force is off after three faults, at most twice per second. The force
/// loop does not print, because it must not wait for a terminal.
class DeviceWatch {
public:
    DeviceWatch(asio::io_context& io, const std::string& device, const HapticTick& hand)
        : timer_(io), reporter_("device " + device), hand_(hand) {
        look();
    }

private:
    void look() {
        timer_.expires_after(std::chrono::milliseconds(500));
        timer_.async_wait([this](error_code error) {
            if (!error) {
                printTroubles();
                const bool before = std::exchange(tripped_, hand_.tripped());
                if (tripped_ && !before) {
                    print(
                        "three faults in ten seconds: the hand feels no force until an operator switches it on "
                        "(sandwall ctl SESSION force on)");
                }
                look();
            }
        });
    }
    void printTroubles() {
        if (const TroubleCounts* troubles = hand_.device().troubles()) {
            for (const std::string& line :
                 reporter_.lines(*troubles, static_cast<double>(host::monotonicNs()) * 1e-9)) {
                print(line);
            }
        }
    }

    asio::steady_timer timer_;
    TroubleReporter reporter_;
    const HapticTick& hand_;
    bool tripped_ = false;  // at the last look
};

std::function<std::vector<base::Bytes>(bool)> ticksOf(TickRecorder* recorder) {
    if (recorder == nullptr) {
        return {};
    }
    return [recorder](bool all) {
        if (all) {
            recorder->flush();
        }
        return recorder->takePieces();
    };
}

scene::Scene loadScene(const std::string& file, const std::function<void(double)>& done) {
    const std::int64_t free = host::freeMemoryOfProcess();
    scene::SizeChecks checks = scene::checksOfServer(file, free);
    checks.progress = done;
    scene::Scene scene = scene::loadScene(file, checks);
    scene::requireServer(scene, file, free);
    return scene;
}

/// Error in the scene that was written to --scene-error-file.
class ReportedError : public base::InputError {
public:
    using base::InputError::InputError;
};

void writeSceneError(const std::string& file, const std::string& line) {
    try {
        host::WholeFile whole(file);
        whole.stream() << line << '\n';
        whole.keep();
    } catch (const base::InputError& refused) {
        throw base::InputError(fmt::format("{}; and --scene-error-file {}", line, refused.what()));
    }
}

/// Reads the scene. `done` gets the part of it that is read, 0 to 1.
scene::Scene openScene(const ServerOptions& options, const std::function<void(double)>& done) {
    scene::Scene scene;
    try {
        scene = loadScene(options.scene, done);
    } catch (const base::InputError& error) {
        if (options.sceneErrorFile.empty()) {
            throw;
        }
        writeSceneError(options.sceneErrorFile, error.what());
        throw ReportedError(error.what());
    }
    for (const scene::RasterStatement& statement : *scene.statements) {
        print(statement.file + ": " + statement.text());
    }
    for (const std::string& warning : scene.warnings) {
        print("warning: " + warning);
    }
    return scene;
}

std::unique_ptr<TickRecorder> recorderOf(const ServerOptions& options, const HapticTick& hand, FirstFailure& failure) {
    if (options.record.empty()) {
        return nullptr;
    }
    return std::make_unique<TickRecorder>(TickRecorder::Options{options.record, options.pace == Pace::fast, print},
                                          hand, failure);
}

Service serviceOf(const ServerOptions& options, const scene::Scene& scene, asio::io_context& io, HapticTick& hand) {
    Service service{.io = io};
    service.identity = {kProtocolVersion, sand::kAlgorithmVersion, scene.rules.digest(), scene.name};
    service.stepsPerSecond = static_cast<std::uint32_t>(scene.rules.stepsPerSecond);
    service.log = print;
    const OwnForce own{options.force ? options.forceScale : 0, options.forceUntilCtl};
    service.shareForce = [&hand, own](const auto& sent) { hand.shareForce(feltShare(own, sent)); };
    service.forceCeiling = own.ceiling();
    service.switchOn = [&hand] { hand.switchOn(); };
    service.tests = options.tests;
    service.mostState = std::max(kMaxState, static_cast<std::size_t>(scene.mostStateBytes()));
    service.mostLoad =
        std::max(kMaxState, static_cast<std::size_t>(scene.rules.stepLimits().mostSandBytes) + kMaxMessage);
    return service;
}

void announce(const ServerOptions& options, const HapticTick& hand, const asio::ip::tcp::endpoint& endpoint) {
    writePortFile("--port-file", options.portFile, endpoint.port());
    for (const std::string& line : hand.limitsInWords()) {
        print(line);
    }
    if (options.guards == Guards::Mode::literal) {
        print("warning: --guards literal sends the law without any limit; for simulated arms only");
    }
    fmt::print("listening on {}\n", textOf(endpoint));
    std::fflush(stdout);
    host::emitEvent("listening", {{"address", textOf(endpoint)}});
}

void runLinks(asio::io_context& io) {
    while (!io.stopped()) {
        try {
            io.run();
        } catch (const std::exception& error) {  // of one link, which ends after a time of silence
            print(std::string("a link failed: ") + error.what());
        }
    }
}

void printEnd(const ServerOptions& options, const HapticTick& hand, const ForceLoop* loop) {
    if (loop != nullptr) {
        print(loop->summary());
    }
    print(hand.guardCounts().inWords());
    if (!options.timings.empty() && loop != nullptr) {
        writeTimings(options.timings, {{"period", &loop->period()}, {"force", &hand.forceCost()}});
    }
}

void serve(const ServerOptions& options) {
    options.checkRealDevice();
    const LinkSecurity security = options.link.forServer();
    const HandSettings settings = HandSettings::parse(options.map);
    asio::io_context io;
    EndSignals signals(io);  // lives longer than the hand, so that a second signal cannot keep it from letting go
    asio::ip::tcp::acceptor acceptor = listenAt(io, options.listen, security.proves());
    const auto endpoint = acceptor.local_endpoint();
    writePortFile("--listening-file", options.listeningFile, endpoint.port());
    signals.onFirst([] {
        print("stopped while it read the scene");
        std::_Exit(0);  // the device is not open yet
    });
    LoadingAnswers loading(io, std::move(acceptor), security, print);
    host::PhaseProgress progress("read", "reads the scene", print);
    scene::Scene scene = openScene(options, [&](double share) {
        loading.setDone(kScene * share);
        progress.done(share);
    });
    const double stripes = std::ceil(static_cast<double>(scene.rules.columns) * scene.rules.rows / sand::kStripe);
    double packed = 0;  // stripes of heights that are compressed
    scene.pack([&] { loading.setDone(kScene + (1 - kScene) * ++packed / stripes); });
    const host::WorkerPool pool(options.sandThreads);
    auto replica = std::optional(sand::Replica::takingHeightsOf(scene, pool.lend()));
    // A device that is open must be closed in order.
    signals.hold([] { print("it ends as soon as the device is open; a second signal ends it at once"); });
    std::unique_ptr<Device> opened = openDevice(options.device, settings, scene);
    const Device& device = *opened;  // the hand takes ownership below
    HandChannel channel;
    Listener* open = nullptr;  // for the thread that runs `io`
    channel.failure.onFailure([&io, &open] {
        asio::post(io, [&io, &open] { open != nullptr ? open->shut("the server has failed") : io.stop(); });
    });
    const auto datum =
        settings.datum.value_or(device.physics() ? HandSettings::Datum::level : HandSettings::Datum::surface);
    HapticTick hand(scene, std::move(opened), datum, options.guards);
    hand.shareForce(0);  // until a master has sent its share
    // So that a master that links before the force loop's first tick also feels the sand under the hand.
    channel.failure.run("device " + options.device, [&hand] { hand.rest(0); });
    channel.failure.rethrow();
    const std::unique_ptr<TickRecorder> recorder = recorderOf(options, hand, channel.failure);
    channel.recorder = recorder.get();

    acceptor = loading.end();
    channel.failure.rethrow();  // the loading has taken the word of a failure
    std::function<Report()> measure;
    Service service = serviceOf(options, scene, io, hand);
    service.report = [&measure] { return measure(); };
    service.ticks = ticksOf(recorder.get());
    service.security = security;
    Listener listener(std::move(service), std::move(acceptor));
    // The sand and force threads end before the link they report to.
    SandThread sandThread(std::move(*replica), options.pace, hand, channel, listener.output());
    replica.reset();
    scene.dropHeights();
    const auto loop = options.pace == Pace::realtime
                          ? std::make_unique<ForceLoop>(hand, channel, options.device, aboutToBeKilled())
                          : nullptr;
    measure = [&] { return measured(hand, loop.get(), sandThread); };
    if (loop != nullptr && !loop->priorityRefused().empty()) {
        print("no real-time priority for the force loop: " + loop->priorityRefused());
    }

    DeviceWatch watch(io, options.device, hand);
    signals.onFirst([&listener] { listener.shut("the server was stopped"); });
    startIsOver();
    if (!io.stopped()) {  // no signal came while the device opened
        listener.serve(sandThread);
        open = &listener;
        announce(options, hand, endpoint);
    }
    runLinks(io);
    if (loop != nullptr) {
        loop->stop();  // pushes 0 before anything that may take long
    }
    channel.failure.rethrow();
    printEnd(options, hand, loop.get());
}

}  // namespace

int main(int count, char** words) {
    const pid_t parent = getppid();
    if (host::answersVersion(count, words, "sandwall-haptic-server",
                             {{"algorithm", sand::kAlgorithmVersion},
                              {"protocol", kProtocolVersion},
                              {"driver_interface", kDriverInterface}})) {
        return 0;
    }
    host::CommandLine line("Feels the sand at 1 kHz, and streams the steps of the hand to the master of a wall.",
                           "sandwall-haptic-server");
    ServerOptions options;
    options.addTo(line);
    if (const std::optional<int> status = line.parse(count, words)) {
        return *status;
    }
    try {
        if (options.endWithParent) {
            endWithParent(parent);
        }
        serve(options);
        return 0;
    } catch (const ReportedError&) {
        return base::kExitBadInput;
    } catch (const base::InputError& error) {
        print(error.what());
        return base::kExitBadInput;
    } catch (const std::exception& error) {
        print(error.what());
        return 1;
    }
}
