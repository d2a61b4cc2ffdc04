#include "host_app/setup/stage_file.h"

#include <utility>

#include <fmt/format.h>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/files/folder.h"
#include "common/config/toml_edit.h"

namespace vantage {
namespace {

constexpr std::size_t max_file_bytes = 1 << 20;

std::string rig_text(const StageConfig::Rig& rig) {
    return fmt::format("\n[[rigs]]\nname = {}\nendpoint = {}\npublic_key = {}\n",
                       toml_string(rig.name), toml_string(rig.endpoint),
                       toml_string(rig.public_key));
}

}  // namespace

StageFile::StageFile(std::filesystem::path file) : file_(std::filesystem::absolute(file)) {
    is_there_ = std::filesystem::exists(file_);
    if (is_there_) config_ = load_stage_config(file_);
    key_file_ = config_.key_file.empty() ? file_.parent_path() / "host.key" : config_.key_file;
}

CurveKeys StageFile::host_keys() const {
    if (!std::filesystem::exists(key_file_)) {
        make_folder(key_file_.parent_path());
        write_key_file(key_file_, generate_curve_keys());
    }
    return load_key_file(key_file_);
}

void StageFile::add(const StageConfig::Rig& rig, double rate_hz) {
    const std::string key_file = toml_string(key_file_.filename().string());
    std::string text;
    if (is_there_) {
        text = read_text_file(file_, max_file_bytes);
        if (config_.key_file.empty()) text = with_toml_value(text, "", "key_file", key_file, file_);
        if (!text.empty() && text.back() != '\n') text += '\n';
    } else {
        text = fmt::format(
            "# The stage, written by vantage setup; the example file of this name has every key.\n"
            "version = 1\nkey_file = {}\nrate_hz = {}\n",
            key_file, rate_hz);
    }
    write(text + rig_text(rig));
    is_there_ = true;
}

void StageFile::write(const std::string& text) {
    make_folder(file_.parent_path());
    // Validated before it replaces the old file, so that a fault leaves that untouched.
    const std::filesystem::path tried = file_.string() + ".new";
    write_text_atomically(tried, text);
    try {
        config_ = load_stage_config(tried);
    } catch (const Error&) {
        std::error_code ignored;
        std::filesystem::remove(tried, ignored);
        throw;
    }
    std::filesystem::rename(tried, file_);
}

namespace {

void add_clock(const RigStatus& rig, std::vector<Finding>& findings) {
    if (!rig.same_clock && !rig.sync.disciplined)
        findings.push_back(
            {rig.rig, false, clock_text(rig),
             "at the rig: sudo systemctl enable --now vantage-ptp vantage-phc2sys, or "
             "vantage-ptp-software where ethtool -T lists no hardware-transmit; the host leads "
             "(docs/build/deploy.md, 5)"});
    if (const std::string worry = tai_warning(rig); !worry.empty())
        findings.push_back(
            {rig.rig, true, worry, "chrony with leapsectz right/UTC on all computers or on none"});
}

void add_calibration(const RigStatus& rig, const std::string& stage_file,
                     std::vector<Finding>& findings) {
    if (!rig.health.calibration_date.empty()) return;
    findings.push_back(
        {rig.rig, false, "it has no calibration file; only a virtual rig films without one",
         fmt::format("vantage-calib stereo --live {} --rig {}=FOLDER --board-file board.toml -o "
                     "FOLDER/calibration.yaml (docs/build/calibration.md)",
                     stage_file, rig.rig)});
}

}  // namespace

std::vector<Finding> findings_of(const ReceiverStatus& status, const std::string& stage_file) {
    std::vector<Finding> findings;
    for (const RigStatus& rig : status.rigs) {
        if (!rig.refused.empty()) {
            findings.push_back({rig.rig, true, rig.refused, ""});
            continue;
        }
        if (!rig.connected) {
            findings.push_back({rig.rig, true, trouble_of(rig),
                                "at the rig: sudo systemctl restart vantage-rig, then: journalctl "
                                "-u vantage-rig"});
            continue;
        }
        if (const std::string trouble = trouble_of(rig); !trouble.empty())
            findings.push_back({rig.rig, true, trouble,
                                trouble == rate_warning(rig)
                                    ? fmt::format("rate_hz in [source] of the rig's rig.toml, or "
                                                  "at the top of {}",
                                                  stage_file)
                                    : ""});
        add_clock(rig, findings);
        add_calibration(rig, stage_file, findings);
    }
    return findings;
}

}  // namespace vantage
