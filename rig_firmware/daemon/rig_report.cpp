#include "rig_firmware/daemon/rig_report.h"

#include <chrono>
#include <thread>

#include <nlohmann/json.hpp>
#include <stdlib.h>
#include <unistd.h>

#include "common/base/child_process.h"
#include "common/base/cli/version.h"
#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/files/secrets.h"
#include "common/base/library_log.h"
#include "common/base/log.h"
#include "common/base/refused_inputs.h"
#include "common/base/time/time.h"
#include "common/config/socket_address.h"
#include "common/wire/limits.h"

namespace vantage {
namespace {

constexpr std::chrono::seconds probe_limit{20};
constexpr std::size_t max_config_bytes = 1 << 18;

/// Temporary file of this process, removed by the destructor.
class ScratchFile {
  public:
    ScratchFile() : path_((std::filesystem::temp_directory_path() / "vantage-XXXXXX").string()) {
        const int fd = ::mkstemp(path_.data());
        if (fd < 0) fail("no file can be made in {}", path_);
        ::close(fd);
    }
    ~ScratchFile() { ::unlink(path_.c_str()); }
    ScratchFile(const ScratchFile&) = delete;
    ScratchFile& operator=(const ScratchFile&) = delete;
    const std::string& path() const { return path_; }

  private:
    std::string path_;
};

/// Runs the probe in a child process, since it opens devices and contexts that this process may
/// hold.
nlohmann::json probe(const std::atomic<bool>& stopping) {
    const ScratchFile out;
    ChildProcess child({.program = program_folder() / "vantage-rig",
                        .arguments = {"probe", "--json", "--quick"},
                        .out = out.path(),
                        .niceness = 10});
    const MonotonicTime end = MonotonicClock::now() + probe_limit;
    while (!child.ended()) {
        if (stopping) fail("the daemon ends");
        if (MonotonicClock::now() > end)
            fail("the probe took longer than {} s", probe_limit.count());
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return nlohmann::json::parse(read_text_file(out.path(), max_report_bytes / 2));
}

}  // namespace

std::string rig_report(const RigConfig& config, const RigNotes& notes,
                       const std::atomic<bool>& stopping) {
    nlohmann::ordered_json report{
        {"rig", config.name}, {"version", version()}, {"computer", computer_words()}};
    const auto add = [&](const char* key, const auto& make) {
        try {
            report[key] = make();
        } catch (const std::exception& error) {
            report[key] = fmt::format("cannot be had: {}", without_secrets(error.what()));
        }
    };
    add("config", [&] { return without_secrets(read_text_file(config.file, max_config_bytes)); });
    report["refused_inputs"] = nlohmann::ordered_json::array();
    for (const RefusedInput& input : refused_inputs())
        report["refused_inputs"].push_back({{"decoder", input.decoder},
                                            {"reason", without_secrets(input.reason)},
                                            {"count", input.count},
                                            {"bytes", input.bytes},
                                            {"hex", input.hex}});
    for (const auto& [library, count] : LibraryLog::counts())
        report["library_messages"][library] = count;
    add("addresses", [] { return own_addresses(); });
    report["clock_steps"] = notes.clock_steps;
    for (const std::string& line : notes.at_start) report["start"].push_back(without_secrets(line));
    for (const std::string& line : recent_log_lines())
        report["log"].push_back(without_secrets(line));
    add("probe", [&] { return probe(stopping); });
    // Device names and files are bytes that need not be valid UTF-8.
    constexpr auto replace = nlohmann::json::error_handler_t::replace;
    std::string text = report.dump(2, ' ', false, replace);
    if (text.size() <= max_report_bytes) return text;
    report["probe"] = "too long";
    text = report.dump(2, ' ', false, replace);
    if (text.size() <= max_report_bytes) return text;
    return nlohmann::ordered_json{{"rig", config.name}, {"version", version()}}.dump(2);
}

}  // namespace vantage
