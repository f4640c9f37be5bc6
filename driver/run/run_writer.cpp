#include "driver/run/run_writer.hpp"

#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "driver/world/files.hpp"
#include "verify/oracle/listing_frame.hpp"

namespace bounce {
namespace fs = std::filesystem;
namespace {

std::size_t particles_of_ring(const Scene& scene, const Problem& problem) {
  return scene.ball.kind == BallKind::rings ? static_cast<std::size_t>(scene.ball.per_ring)
                                            : problem.bonds.particles();
}

}  // namespace

std::optional<RunWriter::Sizes> RunWriter::read_sizes(WordReader* from) {
  if (from == nullptr) return std::nullopt;
  Sizes sizes;
  (*from)(sizes);
  return sizes;
}

RunWriter::RunWriter(const Scene& scene, const Problem& problem, fs::path folder,
                     const WallBooks* books, BounceGauge figures, WordReader* from)
    : RunWriter(scene, problem, std::move(folder), books, std::move(figures), from,
                read_sizes(from)) {}

RunWriter::RunWriter(const Scene& scene, const Problem& problem, fs::path folder,
                     const WallBooks* books, BounceGauge figures, WordReader* from,
                     std::optional<Sizes> sizes)
    : folder_(std::move(folder)),
      time_step_(scene.time.step),
      books_(books),
      monitor_(sizes ? MonitorCsv(folder_ / "monitor.csv", sizes->monitor)
                     : MonitorCsv(folder_ / "monitor.csv")),
      frames_(folder_ / "frames.extxyz", particles_of_ring(scene, problem),
              sizes ? sizes->frames : 0),
      gauges_(problem, std::move(figures), scene.time.step, books != nullptr),
      margin_(problem) {
  const fs::path ledger = folder_ / "ledger.csv";
  if (books != nullptr && sizes) ledger_.emplace(ledger, sizes->ledger);
  if (books != nullptr && !sizes) ledger_.emplace(ledger);
  if (from != nullptr) (*from)(monitor_, gauges_, margin_);
}

void RunWriter::sample(std::int64_t step, const Sample& sample, const State& state) {
  gauges_.add(step, sample, state, books_);
  monitor_.write(time(step), sample, gauges_.last(), margin_.add(step, state));
  if (ledger_ && step > 0) ledger_->write(time(step), gauges_.last());
}

void RunWriter::frame(std::int64_t step, const State& state) {
  frames_.write(step, time(step), state);
}

void RunWriter::listing_frame(std::int64_t step, bool is_end, const State& state) {
  constexpr std::int64_t million = 1'000'000;
  constexpr std::int64_t numbered_files = 19;
  const auto write = [&](const std::string& name) {
    std::ostringstream text;
    write_listing_frame(text, state);
    write_file_whole(folder_ / name, text.str());
  };
  if (step % million == 0 && (step / million <= numbered_files || !is_end)) {
    write(fmt::format("BAL4.OUT{}", step / million));
  }
  if (is_end) write("BAL4.OUT");
}

void RunWriter::write_down(WordWriter& words) {
  Sizes sizes;
  sizes.monitor = monitor_.file().size();
  if (ledger_) sizes.ledger = ledger_->file().size();
  if (OutputFile* frames = frames_.file()) sizes.frames = frames->size();
  words(sizes, monitor_, gauges_, margin_);
}

void RunWriter::sync() {
  monitor_.file().sync();
  if (ledger_) ledger_->file().sync();
  if (OutputFile* frames = frames_.file()) frames->sync();
}

RunFindings RunWriter::finish(const Stepper& stepper, bool unstable) {
  monitor_.close();
  if (ledger_) ledger_->close();
  frames_.close();
  return gauges_.findings(stepper, unstable);
}

}  // namespace bounce
