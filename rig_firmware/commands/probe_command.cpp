#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "common/base/cli/command.h"
#include "rig_firmware/probe/probe.h"

namespace vantage {
namespace {

struct ProbeReport {
    ProbePart libcamera = probe_libcamera();
    ProbePart v4l2 = probe_v4l2();
    ProbePart gpio = probe_gpio();
    ProbePart gpu;
    ProbePart clocks = probe_clocks();
    ProbePart known = probe_known_faults();
    std::vector<std::string> unfit;

    explicit ProbeReport(bool is_quick) : gpu(probe_gpu(!is_quick)) {
        if (libcamera.facts.empty() && v4l2.facts.empty())
            unfit.emplace_back(
                "there is no camera: neither libcamera nor V4L2 lists one that this user may open");
        for (const ProbePart* part : parts())
            unfit.insert(unfit.end(), part->unfit.begin(), part->unfit.end());
    }
    std::vector<const ProbePart*> parts() const {
        return {&libcamera, &v4l2, &gpio, &gpu, &clocks, &known};
    }
};

void print_for_people(const ProbeReport& report) {
    for (const ProbePart* part : report.parts()) {
        std::cout << part->title << ":\n";
        for (const std::string& line : part->lines) std::cout << "  " << line << "\n";
        if (part->lines.empty()) std::cout << "  none\n";
    }
    std::cout << "What is unfit for a rig here:\n";
    for (const std::string& sentence : report.unfit) std::cout << "  - " << sentence << "\n";
    if (report.unfit.empty()) std::cout << "  nothing\n";
}

void print_for_machines(const ProbeReport& report) {
    const nlohmann::json json = {
        {"cameras", {{"libcamera", report.libcamera.facts}, {"v4l2", report.v4l2.facts}}},
        {"gpio", report.gpio.facts},
        {"gpu", report.gpu.facts},
        {"clocks", report.clocks.facts},
        {"known", report.known.facts},
        {"unfit", report.unfit}};
    // Device names are bytes that need not be valid UTF-8.
    std::cout << json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << "\n";
}

}  // namespace

CommandEntry probe_command_entry() {
    return {[](CLI::App& program) {
        auto* command = program.add_subcommand(
            "probe", "List this computer's cameras, GPIO, GPU and clocks, and name faults");
        auto as_json = std::make_shared<bool>(false);
        command->add_flag("--json", *as_json, "Print the result as JSON");
        auto is_quick = std::make_shared<bool>(false);
        command->add_flag("--quick", *is_quick,
                          "Leave out how long the presets take on a GPU that no model describes, "
                          "which takes some seconds to measure");
        command->callback([as_json, is_quick] {
            const ProbeReport report(*is_quick);
            *as_json ? print_for_machines(report) : print_for_people(report);
        });
    }};
}

}  // namespace vantage
