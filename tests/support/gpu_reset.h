#pragma once

namespace vantage {

/// A GPU that is reset, as far as a program can tell: every context that there is says so from now
/// on, if it was made to, and draws nothing any more. Contexts that are made later are well.
void reset_gpu();

}  // namespace vantage
