#include "common/gl/objects/buffer.h"

#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

TEST(Buffer, ReadsWhatWasWritten) {
    const EglContext context;
    const std::vector<int> initial = {1, 2, 3, 4, 5};
    Buffer buffer = Buffer::of(std::span<const int>(initial));
    EXPECT_EQ(buffer.bytes(), 20u);
    const std::array<int, 2> changed = {30, 40};
    buffer.write(8, std::as_bytes(std::span(changed)));
    std::vector<int> back(5);
    buffer.read(0, std::as_writable_bytes(std::span(back)));
    EXPECT_EQ(back, (std::vector<int>{1, 2, 30, 40, 5}));
    std::array<int, 1> one = {};
    buffer.read(16, std::as_writable_bytes(std::span(one)));
    EXPECT_EQ(one[0], 5);
    EXPECT_NO_THROW(buffer.read(0, {}));
}

TEST(Buffer, RefusesMoreThanShadersCanAddressNamingTheLimit) {
    const EglContext context;
    const std::string sentence =
        thrown_sentence([] { Buffer(std::size_t{1} << 31, GL_STATIC_DRAW); });
    EXPECT_NE(sentence.find("2048 MB"), std::string::npos) << sentence;
    EXPECT_NE(sentence.find("2047 MB"), std::string::npos) << sentence;
}

TEST(Buffer, MovesWithItsObject) {
    const EglContext context;
    Buffer a(16, GL_STATIC_DRAW);
    const GLuint name = a.name();
    const Buffer b = std::move(a);
    EXPECT_EQ(b.name(), name);
    EXPECT_TRUE(glIsBuffer(name)) << "deleted once, with its last owner";
    { const Buffer c(4, GL_STATIC_DRAW); }
    EXPECT_TRUE(glIsBuffer(name));
}

}  // namespace
}  // namespace vantage
