#include "common/base/files/descriptor_limit.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

TEST(DescriptorLimit, IsRaisedOrNamedWithTheMend) {
    EXPECT_EXIT(
        {
            rlimit limit{};
            getrlimit(RLIMIT_NOFILE, &limit);
            limit.rlim_cur = 64;
            setrlimit(RLIMIT_NOFILE, &limit);
            require_descriptors(1, "a stage");
            getrlimit(RLIMIT_NOFILE, &limit);
            const bool is_raised = limit.rlim_cur == limit.rlim_max;
            limit.rlim_cur = limit.rlim_max = 64;
            setrlimit(RLIMIT_NOFILE, &limit);
            const std::string sentence =
                thrown_sentence([] { require_descriptors(1000, "a stage of 99 rigs"); });
            const bool is_named =
                sentence.find("a stage of 99 rigs needs 1000 more open files") == 0 &&
                sentence.find("ulimit -n") != std::string::npos;
            _exit(is_raised && is_named ? 7 : 1);
        },
        testing::ExitedWithCode(7), "");
}

}  // namespace
}  // namespace vantage
