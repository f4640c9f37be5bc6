// Files in the listing's format, as the oracle reads them.
#include <sstream>
#include <stdexcept>

#include "verify/oracle/listing_frame.hpp"
#include "verify/tests/fuzz/fuzz_target.hpp"

namespace {

std::string written(const bounce::State& state) {
  std::ostringstream out;
  bounce::write_listing_frame(out, state);
  return out.str();
}

// Four decimals are kept, but for numbers that do not fit.
void read_and_write(const std::string& text) {
  std::istringstream in(text);
  bounce::State state;
  try {
    state = bounce::read_listing_frame(in);
  } catch (const std::runtime_error& error) {
    throw bounce::InputError(error.what());
  }
  const std::string once = written(state);
  if (once.find('*') != std::string::npos) return;
  std::istringstream back(once);
  bounce::must_hold(written(bounce::read_listing_frame(back)) == once,
                    "a frame that is written reads back the same");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return bounce::fuzz(data, size, read_and_write);
}
