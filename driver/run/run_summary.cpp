#include "driver/run/run_summary.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace bounce {
namespace {

using Json = nlohmann::ordered_json;

// "3.1 erg lost to the walls", "3.1 erg gained from the walls".
std::string passed(double gain, std::string_view who) {
  return fmt::format("{:.4g} erg {} {}", std::abs(gain), gain > 0.0 ? "gained from" : "lost to",
                     who);
}

std::string energy_text(const LedgerReport& ledger) {
  return fmt::format("energy: {}{}, {}; it swings by {:.2g} erg\n",
                     passed(ledger.walls, "the walls"), ledger.full ? "" : " (from samples)",
                     passed(ledger.drift, "drift"), ledger.greatest_swing);
}

// A figure with as many digits as it was found to, 15 at most.
std::string digits(const std::optional<Figure>& figure) {
  if (!figure) return "-";
  const double size = std::abs(figure->value), error = figure->found_to;
  if (!(size > 0.0) || !(error > 0.0)) return fmt::format("{:.6g}", figure->value);
  const double known = std::floor(std::log10(size)) - std::floor(std::log10(error));
  return fmt::format("{:.{}g}", figure->value, std::clamp(static_cast<int>(known), 1, 6));
}

std::string contact_text(const Bounce& bounce) {
  if (!bounce.first_contact) return "bounce: no contact\n";
  std::string text = fmt::format(
      "bounce: contact from {} s to {} s, {} s in all; centre lowest at {} cm, then up to {} cm\n",
      digits(bounce.first_contact), digits(bounce.last_contact), digits(bounce.contact_time),
      digits(bounce.lowest_centre), digits(bounce.rebound_height));
  text += bounce.restitution
              ? fmt::format("        coefficient of restitution {}\n", digits(bounce.restitution))
              : "        no coefficient of restitution: not left the wall, or no impact\n";
  return text;
}

std::string fault_text(const LedgerLine& line, double time_step) {
  return fmt::format(
      "        {} DOES NOT CLOSE from step {} (t = {:.9g} s) on: {:.2e} {} left over, at most "
      "{:.2e} explained\n",
      line.name, line.fault_step, static_cast<double>(line.fault_step) * time_step, line.residual,
      line.unit, line.allowed);
}

std::string ledger_text(const RunFindings& findings) {
  const LedgerReport& ledger = findings.ledger;
  std::string text = ledger.closes() ? "ledgers close" : "ledgers DO NOT CLOSE";
  text += ledger.full ? ", every reflection booked"
                      : fmt::format(" on the {:.4g} % of the steps without contact",
                                    100.0 * ledger.free_share);
  text += " (left over; rounding explains: likely, at most)\n";
  for (const LedgerLine& line : ledger.lines) {
    if (!line.closes()) {
      text += fault_text(line, findings.time_step);
    } else {
      text += fmt::format("        {:<22} {:>9.1e} {} ({:.1e}, {:.1e})\n", line.name, line.residual,
                          line.unit, line.likely, line.allowed);
    }
  }
  if (ledger.missed + ledger.otherwise > 0) {
    text += fmt::format("        {} reflections MISSED, {} otherwise than the wall rule\n",
                        ledger.missed, ledger.otherwise);
  }
  return text;
}

Json vector_json(Vec2 v) { return {v.x, v.y}; }

Json line_json(const LedgerLine& line) {
  Json json{{"name", line.name},         {"unit", line.unit},
            {"residual", line.residual}, {"rounding_walk", line.likely},
            {"allowed", line.allowed},   {"closes", line.closes()}};
  if (!line.closes()) json["first_step"] = line.fault_step;
  return json;
}

Json book_json(const WallBook& book) {
  return {{"reflections", book.reflections},
          {"kinetic", book.kinetic.value()},
          {"gravity", book.gravity.value()},
          {"bond", book.bond.value()},
          {"impulse", vector_json({book.impulse_x.value(), book.impulse_y.value()})},
          {"torque", book.torque.value()}};
}

}  // namespace

std::string summary_text(const RunFindings& findings) {
  return energy_text(findings.ledger) + contact_text(findings.bounce) +
         fmt::format("        greatest flattening {} at {} s\n",
                     digits(findings.bounce.greatest_flattening),
                     digits(findings.bounce.greatest_flattening_time)) +
         ledger_text(findings);
}

Json bounce_json(const RunFindings& findings) {
  const Bounce& bounce = findings.bounce;
  Json values, found_to;
  for (const FigureName& each : figure_names) {
    const auto& figure = bounce.*each.figure;
    // Without contact the ball has not rebounded.
    const bool is_known =
        figure && (bounce.first_contact || each.figure != &Bounce::rebound_height);
    const std::string name(each.name);
    values[name] = is_known ? Json(figure->value) : Json();
    found_to[name] = is_known && std::isfinite(figure->found_to) ? Json(figure->found_to) : Json();
  }
  values["found_to"] = found_to;
  return values;
}

Json ledger_json(const RunFindings& findings) {
  const LedgerReport& ledger = findings.ledger;
  Json json{{"form", ledger.full ? "full" : "samples"},
            {"closes", ledger.closes()},
            {"energy_change", ledger.change},
            {"walls", ledger.walls},
            {"drift", ledger.drift},
            {"swing", ledger.swing},
            {"greatest_swing", ledger.greatest_swing},
            {"impulse", vector_json(ledger.impulse)},
            {"torque", ledger.torque},
            {"free_share", ledger.free_share}};
  json["lines"] = Json::array();
  for (const LedgerLine& line : ledger.lines) json["lines"].push_back(line_json(line));
  if (!ledger.full) return json;
  json["missed"] = ledger.missed;
  json["otherwise"] = ledger.otherwise;
  json["wall"] = Json::array();
  for (const WallBook& book : ledger.books) json["wall"].push_back(book_json(book));
  return json;
}

}  // namespace bounce
