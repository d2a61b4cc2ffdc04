#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <thread>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <stdlib.h>

#include "common/base/child_process.h"
#include "common/base/cli/stop_signal.h"
#include "common/base/cli/version.h"
#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/files/folder.h"
#include "common/base/files/secrets.h"
#include "common/base/log.h"
#include "common/base/time/time.h"
#include "common/config/socket_address.h"
#include "common/wire/limits.h"
#include "host_app/commands/rigs/rigs_commands.h"
#include "host_app/session/options/common_options.h"
#include "host_app/session/sync_proof.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

struct ReportOptions {
    std::string stage;
    fs::path output = "vantage-report.tar.gz";
    double wait_s = 30;
    bool json = false;
};

/// A temporary folder with the files of the archive, with secrets removed.
class ReportFolder {
  public:
    ReportFolder() {
        std::string pattern = (fs::temp_directory_path() / "vantage-report-XXXXXX").string();
        if (!::mkdtemp(pattern.data())) fail("cannot create the folder {}", pattern);
        above_ = pattern;
        make_folder(folder() / "rigs");
    }
    ~ReportFolder() {
        std::error_code ignored;
        fs::remove_all(above_, ignored);
    }
    ReportFolder(const ReportFolder&) = delete;
    ReportFolder& operator=(const ReportFolder&) = delete;

    void add(const std::string& name, std::string_view text) const {
        write_text_atomically(folder() / name, without_secrets(text));
    }
    /// Adds a copy of a file; a missing file is left out.
    void add_file(const fs::path& file) const {
        std::error_code ignored;
        if (!fs::is_regular_file(file, ignored)) return;
        try {
            add(file.filename().string(), read_text_file(file, max_report_bytes));
        } catch (const Error& error) {
            add(file.filename().string() + ".fault", error.what());
        }
    }
    /// Adds the output of a program, or why it cannot be run.
    void add_output(const std::string& name, const fs::path& program,
                    const std::vector<std::string>& arguments) const {
        const fs::path raw = above_ / "raw";
        try {
            ChildProcess child(
                {.program = program, .arguments = arguments, .out = raw, .err = raw});
            (void)child.wait();
            add(name, read_text_file(raw, max_log_bytes));
        } catch (const Error& error) {
            add(name, error.what());
        }
    }
    void pack(const fs::path& archive) const {
        const fs::path part = archive.string() + ".part", log = above_ / "tar.log";
        ChildProcess tar({.program = "/usr/bin/tar",
                          .arguments = {"-czf", fs::absolute(part).string(), "-C", above_.string(),
                                        folder().filename().string()},
                          .out = log,
                          .err = log});
        std::error_code failed;
        if (tar.wait() == 0)
            fs::rename(part, archive, failed);
        else
            failed = std::make_error_code(std::errc::io_error);
        if (!failed) return;
        std::error_code ignored;
        fs::remove(part, ignored);
        fail("cannot write {}: {}", archive.string(), read_text_file(log, max_report_bytes));
    }

  private:
    static constexpr std::size_t max_log_bytes = 16 << 20;
    fs::path folder() const { return above_ / "vantage-report"; }

    fs::path above_;
};

/// The keyboard layout of this computer, as its configuration file states it.
std::string keyboard_words() {
    std::error_code ignored;
    for (const char* file : {"/etc/default/keyboard", "/etc/vconsole.conf"})
        if (fs::is_regular_file(file, ignored)) return read_text_file(file, max_report_bytes);
    return "not set";
}

/// Requests a report of every rig and waits until each has answered or cannot, or until the time is
/// up.
ReceiverStatus gather(const StageConfig& stage, double wait_s, const ReportFolder& folder) {
    StageReceiver receiver(stage, StageReceiver::Purpose::observe);
    StopSignal stop;
    receiver.ask_for_reports();
    constexpr std::chrono::seconds to_connect(3);
    const MonotonicTime begun = MonotonicClock::now();
    const std::chrono::nanoseconds wait = from_s(wait_s);
    const auto is_through = [&](const RigStatus& rig, std::size_t number) {
        if (receiver.report_of(number) || !rig.refused.empty()) return true;
        const auto passed = MonotonicClock::now() - begun;
        if (rig.connected) return rig.health.program_version.empty() && passed > to_connect;
        return passed > to_connect;
    };
    ReceiverStatus status;
    bool all = false;
    while (!all && MonotonicClock::now() - begun < wait &&
           !stop.wait_for(StopSignal::look_period)) {
        status = receiver.status();
        all = true;
        for (std::size_t i = 0; i < status.rigs.size(); ++i)
            all = is_through(status.rigs[i], i) && all;
    }
    status = receiver.status();
    for (std::size_t i = 0; i < status.rigs.size(); ++i) {
        const std::string& name = status.rigs[i].rig;
        if (const auto report = receiver.report_of(i))
            folder.add("rigs/" + name + ".json", *report);
        else
            folder.add(
                "rigs/" + name + ".txt",
                trouble_of(status.rigs[i]).empty()
                    ? fmt::format("no report within {:g} s; its version may be too old\n", wait_s)
                    : trouble_of(status.rigs[i]) + '\n');
    }
    return status;
}

void run(const ReportOptions& options) {
    const StageConfig stage = load_stage_config(options.stage);
    const ReportFolder folder;
    const ReceiverStatus status = gather(stage, options.wait_s, folder);
    nlohmann::ordered_json rigs = nlohmann::ordered_json::array();
    std::size_t answered = 0;
    for (const RigStatus& rig : status.rigs) {
        rigs.push_back(to_json(rig, status.rigs));
        answered += rig.connected;
    }
    const SyncProof proof = sync_proof_of(options.stage);
    folder.add(
        "status.json",
        nlohmann::ordered_json{{"version", version()},
                               {"computer", computer_words()},
                               {"addresses", own_addresses()},
                               {"keyboard", keyboard_words()},
                               {"sync_proof", to_json(proof, std::chrono::system_clock::now())},
                               {"rigs", rigs}}
            .dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    const fs::path stage_file = options.stage;
    folder.add_file(stage_file);
    folder.add_file(stage_file.parent_path() / "live.env");
    folder.add_file(sync_file_of(stage_file));
    folder.add_output("host_log.txt", "/usr/bin/journalctl",
                      {"--user", "--unit", "vantage-live", "--lines", "1000", "--no-pager",
                       "--output", "short-iso"});
    folder.pack(options.output);
    if (options.json)
        std::cout << nlohmann::ordered_json{{"file", options.output.string()},
                                            {"rigs", status.rigs.size()},
                                            {"answered", answered}}
                         .dump()
                  << '\n';
    else
        std::cout << fmt::format(
            "wrote {}: {} of {} rigs answered. Keys and passphrases are removed; read it before "
            "you send it.\n",
            options.output.string(), answered, status.rigs.size());
}

}  // namespace

void add_rigs_bugreport(CLI::App& rigs) {
    auto options = std::make_shared<ReportOptions>();
    CLI::App* report = rigs.add_subcommand(
        "bugreport",
        "Collect versions, configuration, status, logs and probes of this host and its rigs in an "
        "archive for support, without keys and passphrases");
    report->add_option("--stage", options->stage, stage_file_help)->required();
    report->add_option("-o,--output", options->output, "Write this archive (.tar.gz)")
        ->capture_default_str();
    report->add_option("--wait", options->wait_s, "Wait at most this many seconds for the rigs")
        ->check(CLI::Range(0.1, 3600.0))
        ->capture_default_str();
    report->add_flag("--json", options->json, "Print the result as JSON");
    report->callback([options] { run(*options); });
}

}  // namespace vantage
