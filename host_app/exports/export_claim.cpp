#include "host_app/exports/export_claim.h"

#include <algorithm>
#include <string>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/files/folder.h"

namespace vantage {
namespace {

constexpr const char* name = "export.json";

bool holds_others(const std::filesystem::path& folder) {
    const std::filesystem::directory_iterator files(folder);
    return std::any_of(begin(files), end(files), [](const auto& entry) {
        return !entry.path().filename().string().starts_with(name);
    });
}

}  // namespace

void claim_folder(const std::filesystem::path& folder, const TakeReader& take,
                  const nlohmann::ordered_json& what) {
    make_folder(folder);
    const nlohmann::ordered_json claim{
        {"version", 1},
        {"origin_tai_ns", take.facts().origin.time_since_epoch().count()},
        {"program", take.facts().program},
        {"bytes", take.bytes()},
        {"as", what}};
    const std::string text = claim.dump(1) + '\n';
    const std::filesystem::path file = folder / name;
    // Several processes may begin parts of one export at a time. If another one has created
    // export.json since the first check, its files are not foreign.
    if (!std::filesystem::exists(file) && holds_others(folder) && !std::filesystem::exists(file))
        fail("{} contains other files: choose a new name", folder.string());
    if (!std::filesystem::exists(file)) write_text_atomically(file, text);
    constexpr std::size_t most_bytes = 1 << 16;
    if (read_text_file(file, most_bytes) != text)
        fail(
             "{} contains another export, of another take or format: choose a new name, or delete "
             "it",
            folder.string());
}

}  // namespace vantage
