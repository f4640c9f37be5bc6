#include "driver/extremes/extreme_run.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "driver/scene/state_file.hpp"
#include "driver/world/child_process.hpp"
#include "driver/world/files.hpp"
#include "verify/watch/compensated_sum.hpp"
#include "verify/watch/rounding_size.hpp"

namespace bounce {
namespace {

namespace fs = std::filesystem;

using Json = nlohmann::json;
using Words = std::vector<std::string>;

constexpr double time_limit = 1800.0;  // s; a row that takes longer hangs
constexpr std::int64_t steps_to_run_on = 1000;

std::string one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

Json read_json(const fs::path& path) { return Json::parse(read_text_file(path.string())); }

// `bounce run WORDS --out NAME` in the folder; the files are NAME.out, NAME.err and NAME/.
class Run {
 public:
  Run(const fs::path& folder, const std::string& name, Words words) : folder_(folder), name_(name) {
    words.insert(words.begin(), "run");
    words.insert(words.end(), {"--out", name, "--threads", "1", "--quiet"});
    end_ = run_this_program(words, folder, name + ".out", name + ".err", time_limit);
  }
  [[nodiscard]] int exit_code() const { return end_.exited() ? end_.exit_code : -1; }
  [[nodiscard]] std::string message() const {
    return one_line(read_text_file((folder_ / (name_ + ".err")).string()));
  }
  [[nodiscard]] Json record() const { return read_json(folder_ / name_ / "run.json"); }
  [[nodiscard]] State last() const {
    return read_state((folder_ / name_ / "final.csv").string()).state;
  }
  // Anything but the files above.
  [[nodiscard]] bool left_something() const {
    return std::any_of(fs::directory_iterator(folder_), {}, [this](const fs::directory_entry& at) {
      const std::string file = at.path().filename();
      return file == name_ || file.starts_with(name_ + ".partial");
    });
  }
  // Why it did not end by itself or as no run may; "" if it ended well.
  [[nodiscard]] std::string fault() const {
    if (end_.timed_out) return fmt::format("no end after {:g} s", time_limit);
    if (end_.signal != 0) return fmt::format("killed by signal {}", end_.signal);
    if (end_.exit_code == 0 || end_.exit_code == 2 || end_.exit_code == 3) return "";
    return fmt::format("exit code {}: {}", end_.exit_code, message());
  }

 private:
  const fs::path& folder_;
  std::string name_;
  ProcessEnd end_;
};

// "; walls DO NOT CLOSE" for each line that does not.
std::string open_ledgers(const Json& record) {
  std::string text;
  for (const Json& line : record["ledger"]["lines"]) {
    if (!line["closes"].get<bool>()) {
      text += fmt::format("; {} DOES NOT CLOSE from step {} on ({} {}, allowed {})",
                          line["name"].get<std::string>(), line["first_step"].dump(),
                          line["residual"].dump(), line["unit"].get<std::string>(),
                          line["allowed"].dump());
    }
  }
  return text;
}

bool ledgers_close(const Json& record) {
  return record["ledger"]["closes"].get<bool>() && open_ledgers(record).empty();
}

class Judge {
 public:
  Judge(const ExtremeRow& row, const fs::path& folder) : row_(row), folder_(folder) {}

  ExtremeResult run() {
    write_file_whole(folder_ / scene_, row_.text);
    words_ = {scene_};
    if (const auto start = start_of(row_)) {
      const std::string name = row_.name + ".csv";
      write_file_whole(folder_ / name, [&start](OutputFile& out) { write_state_csv(out, *start); });
      words_.insert(words_.end(), {"--initial", name});
    }
    if (row_.force) words_.emplace_back("--force");
    const Run run(folder_, row_.name, words_);
    result_.exit_code = run.exit_code();
    result_.happened = "fails";
    if (const std::string fault = run.fault(); !fault.empty()) {
      result_.detail = fault;
      return result_;
    }
    const bool proper = result_.exit_code == 0   ? is_complete(run)
                        : result_.exit_code == 2 ? is_refused(run)
                                                 : stops_properly(run);
    result_.as_expected = proper && result_.happened == name_of(row_.expected);
    return result_;
  }

 private:
  bool is_complete(const Run& run) {
    result_.happened = name_of(Outcome::complete);
    const Json record = run.record();
    note(record);
    result_.detail = fmt::format("{} steps", result_.steps);
    bool good = record["status"] == "complete" && is_finite(run.last());
    if (!good) result_.detail += "; its last state is not finite";
    good = closes(record, "") && good;
    if (row_.booked > 0) {
      Words words = words_;
      words.insert(words.end(), {"--ledger", "--steps", std::to_string(row_.booked)});
      const Run booked(folder_, row_.name + "-booked", words);
      if (booked.exit_code() != 0) {
        result_.detail += "; booked: exit code " + std::to_string(booked.exit_code());
        return false;
      }
      good = closes(booked.record(), fmt::format(", booked {} steps", row_.booked)) && good;
    }
    return good;
  }

  bool closes(const Json& record, const std::string& of) {
    const bool close = ledgers_close(record);
    const double share = 100.0 * record["ledger"]["free_share"].get<double>();
    const std::string from = of.empty() ? fmt::format(" ({:.3g} % free)", share) : "";
    result_.detail +=
        of + (close ? (of.empty() ? "; ledgers close" : " too") : open_ledgers(record)) + from;
    return close;
  }

  bool is_refused(const Run& run) {
    result_.happened = name_of(Outcome::refused);
    result_.detail = run.message();
    // The file in front is the row's own.
    const std::string front = "bounce: " + scene_;
    if (result_.detail.starts_with(front)) {
      result_.detail = result_.detail.substr(result_.detail.find(": ", front.size()) + 2);
    }
    return tells(run) && !leaves(run);
  }

  bool leaves(const Run& run) {
    if (!run.left_something()) return false;
    result_.detail += "; BUT IT LEFT FILES";
    return true;
  }

  // The message holds what the row wants it to.
  bool tells(const Run& run) {
    const std::string message = run.message();
    if (!message.empty() && message.find(row_.says) != std::string::npos) return true;
    result_.detail += "; THE MESSAGE LACKS \"" + row_.says + "\"";
    return false;
  }

  bool stops_properly(const Run& run) {
    result_.happened = name_of(Outcome::stops);
    const Json record = run.record();
    note(record);
    const Json& trouble = record["trouble"];
    const Json& step = trouble["stable_step"];
    result_.detail = fmt::format("at step {}, {}", trouble["step"].dump(), describe(trouble));
    if (record["status"] != "unstable" || trouble["last_good"].is_null() || !step.is_number() ||
        !trouble.contains("bond") || !is_finite(run.last())) {
      result_.detail += "; THE REPORT OR THE LAST GOOD STATE IS NOT WHOLE";
      return false;
    }
    return tells(run) && runs_on(step.get<double>());
  }

  static std::string describe(const Json& trouble) {
    if (!trouble.contains("bond")) return "no bond named";
    const auto part = [](const Json& state) {
      return state.is_null() || state["part"].is_null()
                 ? std::string("?")
                 : fmt::format("{:.4g}", state["part"].get<double>());
    };
    return fmt::format("bond {}-{} ({}); {} of the stable step before, {} then",
                       trouble["bond"][0].dump(), trouble["bond"][1].dump(),
                       trouble["bond_class"].get<std::string>(), part(trouble["last_good"]),
                       part(trouble["refused"]));
  }

  // From the last good state, with the step that the report proposes.
  bool runs_on(double step) {
    const std::string name = row_.name + "-on";
    const Run run(folder_, name,
                  {row_.name + "/scene.toml", "--initial", row_.name + "/final.csv", "--set",
                   fmt::format("time.step={}", step), "--set",
                   fmt::format("output.monitor_every={}", 10.0 * step), "--steps",
                   std::to_string(steps_to_run_on)});
    if (run.exit_code() == 0 && ledgers_close(run.record())) {
      result_.detail += fmt::format("; runs on at {:.2g} s", step);
      return true;
    }
    result_.detail += fmt::format("; DOES NOT RUN ON at {:.2g} s: exit code {} {}", step,
                                  run.exit_code(), run.message());
    return false;
  }

  void note(const Json& record) {
    result_.steps = record["steps"].get<std::int64_t>();
    if (const auto& stability = record["stability"]; stability.contains("greatest_part")) {
      result_.greatest_part = stability["greatest_part"]["part"].get<double>();
    }
  }

  const ExtremeRow& row_;
  const fs::path& folder_;
  std::string scene_ = row_.name + ".toml";
  Words words_;
  ExtremeResult result_;
};

}  // namespace

ExtremeResult run_extreme_row(const ExtremeRow& row, const fs::path& folder, bool is_compared) {
  try {
    ExtremeResult result = Judge(row, folder).run();
    if (is_compared && result.happened == name_of(Outcome::complete)) {
      result.last = read_state((folder / row.name / "final.csv").string()).state;
    }
    return result;
  } catch (const std::exception& error) {  // run.json lacks something, a file cannot be read
    ExtremeResult result;
    result.happened = "fails";
    result.detail = one_line(error.what());
    return result;
  }
}

namespace {

Vec2 measure_centre(const State& state) {
  CompensatedSum x, y;
  for (const double value : state.x) x.add(value);
  for (const double value : state.y) y.add(value);
  const auto n = static_cast<double>(state.size());
  return {x.value() / n, y.value() / n};
}

}  // namespace

// A particle's coordinate is rounded once at the start and once a step, each time by at most 2^-53
// of the place's size. The far ball's forces differ by what that does to bonds, which is no more.
void compare_with_like(const ExtremeRow& row, const ExtremeRow& like, const State& near,
                       ExtremeResult& result) {
  const State& far = result.last;
  const Vec2 offset{row.scene.ball.centre.x - like.scene.ball.centre.x,
                    row.scene.ball.centre.y - like.scene.ball.centre.y};
  double difference = 0.0;
  for (std::size_t i = 0; i < far.size(); ++i) {
    const double dx = std::abs(far.x[i] - offset.x - near.x[i]);
    const double dy = std::abs(far.y[i] - offset.y - near.y[i]);
    difference = std::max({difference, dx, dy});
    if (std::isnan(dx) || std::isnan(dy)) difference = std::nan("");
    if (std::isnan(difference)) break;
  }
  const Vec2 centre = measure_centre(near);
  const Vec2 far_centre = measure_centre(far);
  const Vec2 start = like.scene.ball.centre;
  const double moved = std::hypot(centre.x - start.x, centre.y - start.y);
  const double lost =
      std::hypot(far_centre.x - offset.x - centre.x, far_centre.y - offset.y - centre.y);
  RoundingSize rounding;
  rounding.add(std::max(std::abs(offset.x), std::abs(offset.y)),
               static_cast<double>(result.steps + 1));
  result.detail += fmt::format(
      "; a particle ends up to {:.2g} cm off {}, the centre {:.2g} cm of the {:.3g} cm that it "
      "moved; "
      "roundings of the positions explain {:.2g} cm (independent) to {:.2g} cm (of one sign)",
      difference, like.name, lost, moved, rounding.likely(), rounding.worst);
  if (!(difference <= rounding.worst)) {
    result.detail += ": TOO FAR";
    result.as_expected = false;
  }
}

}  // namespace bounce
