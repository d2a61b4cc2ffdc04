#include "tests/hil/devices/rig_process.h"

#include <chrono>
#include <csignal>
#include <fstream>

#include "common/base/error.h"
#include "common/config/rig_config.h"
#include "common/config/stage_config.h"
#include "common/receive/stage_receiver.h"

namespace vantage {
namespace {

constexpr std::chrono::seconds longest_frame_wait{300};

StageConfig stage_of(const std::string& endpoint, double rate_hz) {
    StageConfig stage;
    stage.rate_hz = rate_hz;
    stage.rigs.push_back({.name = "rig", .endpoint = endpoint, .public_key = {}});
    return stage;
}

}  // namespace

struct RigProcess::Receiver {
    explicit Receiver(const StageConfig& stage) : stage_receiver(stage) {}
    StageReceiver stage_receiver;
};

RigProcess::RigProcess(const std::string& parts) {
    const std::string endpoint = "tcp://127.0.0.1:5690";
    std::ofstream(config_file()) << "version = 1\nname = \"rig\"\n"
                                 << parts << "[stream]\nbind = \"" << endpoint << "\"\n";
    start();
    receiver_ = std::make_shared<Receiver>(
        stage_of(endpoint, load_rig_config(config_file()).source.rate_hz));
}

std::filesystem::path RigProcess::config_file() const { return folder_.path() / "rig.toml"; }

void RigProcess::start() {
    program_ = std::make_unique<ChildProgram>(
        VANTAGE_RIG_PROGRAM,
        std::vector<std::string>{"run", "--config", config_file().string(), "--json"},
        folder_.path());
}

std::shared_ptr<const RigFrame> RigProcess::next_frame() {
    const auto end = std::chrono::steady_clock::now() + longest_frame_wait;
    while (std::chrono::steady_clock::now() < end) {
        if (const auto set = receiver_->stage_receiver.next(std::chrono::seconds(1)))
            if (set->slots[0].frame) return set->slots[0].frame;
        if (const auto status = program_->ended())
            fail("the rig ended with {}; it said: {}", *status, log());
    }
    fail("no frame of the rig came within {} s; it said: {}", longest_frame_wait.count(), log());
}

std::string RigProcess::stop() {
    program_->send_signal(SIGTERM);
    return program_->wait().out;
}

}  // namespace vantage
