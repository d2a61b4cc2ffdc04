#include "common/colour/colour_file.h"

#include <span>

#include <fmt/ranges.h>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/config/toml_reader.h"

namespace vantage {
namespace {

constexpr int file_version = 1;
constexpr std::size_t max_file_bytes = 1 << 16;
using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

bool is_good(const std::filesystem::path& path) {
    try {
        load_colour(path);
        return true;
    } catch (const Error&) {
        return false;
    }
}

}  // namespace

ColourCorrection load_colour(const std::filesystem::path& path) {
    RowMajor matrix = RowMajor::Identity();
    ColourCorrection correction;
    ColourRecord record;
    read_toml_file(path, file_version, [&](TomlTable& top) {
        top.read("matrix", std::span<double>(matrix.data(), 9));
        top.read("tone", std::span<double>(correction.tone.data(), 3));
        for (const char* key : {"matrix", "tone"}) top.require(key);
        top.read("date", record.date);
        top.read("tool", record.tool);
        top.read("reference", record.reference);
        top.read("delta_e_before", record.delta_e_before);
        top.read("delta_e_after", record.delta_e_after);
        top.read("samples", record.samples);
    });
    correction.matrix = matrix;
    try {
        correction.validate();
    } catch (const Error& error) {
        fail("{}: {}", path.string(), error.what());
    }
    return correction;
}

void save_colour(const std::filesystem::path& path, const ColourCorrection& correction,
                 const ColourRecord& record) {
    correction.validate();
    const RowMajor matrix = correction.matrix;
    const std::string text = fmt::format(
        "# The colour correction of one camera: encode(matrix * decode(camera) ^ tone), with\n"
        "# sRGB's transfer function. stage.toml names this file in the rig's key `colour`.\n"
        "version = {}\ndate = \"{}\"\ntool = \"{}\"\nreference = \"{}\"\n"
        "delta_e_before = {:.4f}   # mean CIEDE2000 from the reference\ndelta_e_after = {:.4f}\n"
        "samples = {}\nmatrix = [{:.9g}]\ntone = [{:.9g}]\n",
        file_version, record.date, record.tool, record.reference, record.delta_e_before,
        record.delta_e_after, record.samples,
        fmt::join(std::span<const double>(matrix.data(), 9), ", "),
        fmt::join(std::span<const double>(correction.tone.data(), 3), ", "));
    if (std::filesystem::exists(path) && is_good(path))
        write_file_atomically(path.string() + ".last", read_file(path, max_file_bytes));
    write_text_atomically(path, text);
}

}  // namespace vantage
