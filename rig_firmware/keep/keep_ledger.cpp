#include "rig_firmware/keep/keep_ledger.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/log.h"

namespace vantage {
namespace {

constexpr int ledger_version = 1;
constexpr std::size_t most_ledger_bytes = 16 << 20;

}  // namespace

KeepLedger::KeepLedger(const std::filesystem::path& folder, const std::string& rig)
    : path_(folder / ("." + rig + ".keep.json")) {
    std::error_code ignored;
    if (!std::filesystem::exists(path_, ignored)) return;
    try {
        const auto json = nlohmann::json::parse(read_text_file(path_, most_ledger_bytes));
        if (json.at("version") != ledger_version) fail("its version is not {}", ledger_version);
        kept_s_ = json.at("kept_s").get<double>();
        for (const nlohmann::json& file : json.at("files"))
            entries_.push_back({file.at("name").get<std::string>(),
                                file.at("number").get<std::uint64_t>(),
                                std::min(file.at("ended_s").get<double>(), kept_s_)});
        std::sort(entries_.begin(), entries_.end(),
                  [](const Entry& a, const Entry& b) { return a.number < b.number; });
    } catch (const std::exception& error) {
        log_warning("{} cannot be read and is begun anew: {}", path_.string(), error.what());
        entries_.clear();
        kept_s_ = 0;
    }
}

void KeepLedger::reconcile(const std::vector<KeptFile>& files) {
    const auto is_of = [](const KeptFile& file) {
        return [name = file.path.filename().string()](const Entry& entry) {
            return entry.name == name;
        };
    };
    std::erase_if(entries_, [&](const Entry& entry) {
        return std::none_of(files.begin(), files.end(), [&](const KeptFile& file) {
            return file.path.filename().string() == entry.name;
        });
    });
    for (const KeptFile& file : files)
        if (std::none_of(entries_.begin(), entries_.end(), is_of(file)))
            entries_.push_back({file.path.filename().string(),
                                entries_.empty() ? 1 : entries_.back().number + 1, kept_s_});
}

void KeepLedger::save() const {
    nlohmann::ordered_json json{{"version", ledger_version}, {"kept_s", kept_s_}};
    json["files"] = nlohmann::ordered_json::array();
    for (const Entry& entry : entries_)
        json["files"].push_back(
            {{"name", entry.name}, {"number", entry.number}, {"ended_s", entry.ended_s}});
    constexpr auto replace = nlohmann::json::error_handler_t::replace;
    write_text_atomically(path_, json.dump(1, ' ', false, replace) + '\n');
}

}  // namespace vantage
