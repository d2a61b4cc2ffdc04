#include "host_app/exports/export_claim.h"

#include <string>

#include "common/base/atomic_file.h"
#include "common/base/error.h"
#include "common/base/folder.h"

namespace vantage {

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
    const std::filesystem::path file = folder / "export.json";
    if (std::filesystem::exists(file)) {
        constexpr std::size_t most_bytes = 1 << 16;
        if (read_text_file(file, most_bytes) != text)
            fail(
                "{} holds another export already, of another take or as something else: give a "
                "new name, or take it away",
                folder.string());
        return;
    }
    if (!std::filesystem::is_empty(folder))
        fail("{} holds other files: give a new name", folder.string());
    write_text_atomically(file, text);
}

}  // namespace vantage
