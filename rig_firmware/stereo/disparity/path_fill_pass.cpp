#include "rig_firmware/stereo/disparity/path_fill_pass.h"

#include <string>

#include "rig_firmware/stereo/features/halve_pass.h"

namespace vantage {
namespace {

Program program_of(const ShaderLibrary& library, const char* shader, FillCell cell,
                   ShaderDefines defines = {}) {
    defines.emplace_back("CELL", std::to_string(px_of(cell)));
    return Program::compute(library, shader, std::move(defines));
}

}  // namespace

PathFillPass::PathFillPass(const ShaderLibrary& library, const StereoLayout& layout, FillCell cell)
    : layout_(layout),
      cell_layout_(cell == FillCell::one_px ? layout : halved(layout)),
      make_cells_(program_of(library, "path_fill_cells.comp", cell)),
      island_rows_(Program::compute(library, "path_fill_island_rows.comp")),
      island_columns_(Program::compute(library, "path_fill_island_columns.comp",
                                       {{"LEAST_AREA", std::to_string(min_island_cells) + "u"}})),
      first_rows_(program_of(library, "path_fill_rows.comp", cell)),
      columns_(program_of(library, "path_fill_columns.comp", cell)),
      last_rows_(program_of(library, "path_fill_rows.comp", cell, {{"LAST", "1"}})),
      spread_(program_of(library, "path_fill_spread.comp", cell)),
      cells_(cell_layout_.pixels() * 4, GL_DYNAMIC_COPY),
      paths_(cell_layout_.pixels() * 4, GL_DYNAMIC_COPY) {}

void PathFillPass::walk(Program& program, int invocations) {
    program.use();
    program.set("size", Eigen::Vector2i(cell_layout_.width_px, cell_layout_.height_px));
    program.set("stride", cell_layout_.stride_px());
    cells_.bind_storage(0);
    paths_.bind_storage(1);
    program.dispatch_over(invocations, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void PathFillPass::run(PassProfiler& profiler, const Buffer& luma, const Buffer& disparity,
                       const Buffer& filled) {
    const std::size_t pixels = layout_.pixels(), cells = cell_layout_.pixels();
    const int rows = cell_layout_.height_px, columns_of_four = (cell_layout_.width_px + 3) / 4;
    profiler.run(
        "fill", {pixels * 14 + cells * 112, static_cast<double>(pixels + cells) * 154}, [&] {
            make_cells_.use();
            make_cells_.set("size", Eigen::Vector2i(layout_.width_px, layout_.height_px));
            make_cells_.set("stride", layout_.stride_px());
            make_cells_.set("luma_row_words", layout_.luma_row_words());
            make_cells_.set("cells_size",
                            Eigen::Vector2i(cell_layout_.width_px, cell_layout_.height_px));
            make_cells_.set("cells_stride", cell_layout_.stride_px());
            disparity.bind_storage(0);
            luma.bind_storage(1);
            cells_.bind_storage(2);
            make_cells_.dispatch_over(columns_of_four, rows);
            glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);

            walk(island_rows_, rows);
            walk(island_columns_, columns_of_four);
            walk(first_rows_, rows);
            walk(columns_, columns_of_four);
            walk(last_rows_, rows);

            spread_.use();
            spread_.set("size", Eigen::Vector2i(layout_.width_px, layout_.height_px));
            spread_.set("stride", layout_.stride_px());
            spread_.set("cells_stride", cell_layout_.stride_px());
            disparity.bind_storage(0);
            filled.bind_storage(1);
            paths_.bind_storage(2);
            spread_.dispatch_over((layout_.width_px + 3) / 4, layout_.height_px);
            glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        });
}

}  // namespace vantage
