#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "host_app/control/hid/jog_family.h"
#include "tests/support/source_folder.h"

namespace vantage {
namespace {

TEST(JogUdevRules, NameEveryModelThatVantageReads) {
    std::ostringstream rules;
    rules << std::ifstream(source_folder() / "udev/70-vantage-jog.rules").rdbuf();
    for (const JogFamily& family : jog_families())
        for (const JogModel& model : family.models) {
            const std::string line =
                family.transport == JogTransport::hidraw
                    ? fmt::format("\nKERNELS==\"*:{:04X}:{:04X}.*\", GOTO=\"vantage_jog_allow\"\n",
                                  model.id.vendor, model.id.product)
                    : fmt::format(
                          "\nATTRS{{id/vendor}}==\"{:04x}\", ATTRS{{id/product}}==\"{:04x}"
                          "\", GOTO=\"vantage_jog_allow\"\n",
                          model.id.vendor, model.id.product);
            EXPECT_NE(rules.str().find(line), std::string::npos) << model.name << line;
        }
}

}  // namespace
}  // namespace vantage
