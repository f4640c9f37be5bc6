// States that --initial reads, in either format.
#include <sys/mman.h>

#include "driver/scene/state_file.hpp"
#include "verify/tests/fuzz/fuzz_target.hpp"

namespace {

// Through a file in memory; its name is that of what holds it.
bounce::FiledState there_and_back(const bounce::FiledState& filed) {
  const int descriptor = ::memfd_create("state", MFD_CLOEXEC);
  bounce::must_hold(descriptor >= 0, "a file in memory can be made");
  const std::string path = "/proc/self/fd/" + std::to_string(descriptor);
  bounce::OutputFile file(descriptor, path);
  bounce::write_state_csv(file, filed.state, filed.held);
  file.flush();
  return bounce::read_state(path);
}

void read_and_write(std::string bytes) {
  const bounce::FiledState filed =
      bounce::parse_state(bounce::text_of(std::move(bytes), "input"), "input");
  if (!bounce::is_finite(filed.state)) return;  // a problem refuses it
  const bounce::FiledState again = there_and_back(filed);
  bounce::must_hold(bounce::state_hash(again.state) == bounce::state_hash(filed.state),
                    "a state that is written reads back the same");
  bounce::must_hold(again.held.has_value() == filed.held.has_value(), "and what is held over");
  if (!filed.held || !bounce::is_finite(*filed.held)) return;
  bounce::must_hold(bounce::state_hash(*again.held) == bounce::state_hash(*filed.held),
                    "and what is held over reads back the same");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return bounce::fuzz(data, size, read_and_write);
}
