#include "driver/scene/scene_keys.hpp"

#include <array>
#include <optional>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace bounce {
namespace {

// For each type of value: which TOML it is read from, how it is written, what a message says.

const std::string number_text = "a number, as in 0.5 or 1e-6";

bool read(const toml::node& node, double& out) {
  if (node.is_integer()) {
    out = static_cast<double>(*node.value_exact<std::int64_t>());
    return true;
  }
  if (!node.is_floating_point()) return false;
  out = *node.value_exact<double>();
  return true;
}
std::string write(double x) {
  std::string text = fmt::format("{}", x);  // shortest that reads back the same
  if (text.find_first_not_of("-0123456789") == std::string::npos) text += ".0";
  return text;
}
std::string allowed_for(double) { return number_text; }

bool read(const toml::node& node, std::int64_t& out) {
  if (!node.is_integer()) return false;
  out = *node.value_exact<std::int64_t>();
  return true;
}
std::string write(std::int64_t x) { return fmt::format("{}", x); }
std::string allowed_for(std::int64_t) { return "a whole number"; }

bool read(const toml::node& node, std::string& out) {
  if (!node.is_string()) return false;
  out = *node.value_exact<std::string>();
  return true;
}
std::string write(const std::string& text) {
  std::ostringstream out;  // on one line, whatever the text holds
  out << toml::toml_formatter(toml::value<std::string>(text), toml::format_flags::none);
  return out.str();
}
std::string allowed_for(const std::string&) { return "text in quotes"; }

bool read(const toml::node& node, std::vector<double>& out) {
  const toml::array* array = node.as_array();
  if (array == nullptr) return false;
  std::vector<double> values(array->size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!read((*array)[i], values[i])) return false;
  }
  out = std::move(values);
  return true;
}
std::string write(const std::vector<double>& values) {
  std::vector<std::string> texts;
  texts.reserve(values.size());
  for (const double x : values) texts.push_back(write(x));
  return texts.empty() ? "" : fmt::format("[{}]", fmt::join(texts, ", "));
}
std::string allowed_for(const std::vector<double>&) {
  return "a list of numbers, as in [5.0, 6.0]";
}

bool read(const toml::node& node, Vec2& out) {
  std::vector<double> values;
  if (!read(node, values) || values.size() != 2) return false;
  out = {values[0], values[1]};
  return true;
}
std::string write(Vec2 v) { return fmt::format("[{}, {}]", write(v.x), write(v.y)); }
std::string allowed_for(Vec2) { return "two numbers, as in [0.0, 10.0]"; }

bool read(const toml::node& node, std::optional<double>& out) {
  double value = 0.0;
  if (!read(node, value)) return false;
  out = value;
  return true;
}
std::string write(const std::optional<double>& x) { return x ? write(*x) : ""; }
std::string allowed_for(const std::optional<double>&) { return number_text; }

// The words of each choice.
template <class Choice, std::size_t count = 2>
using Words = std::array<std::pair<const char*, Choice>, count>;
Words<Constants> words_of(Constants) {
  return {{{"single", Constants::single_precision}, {"double", Constants::double_precision}}};
}
Words<Rounding> words_of(Rounding) {
  return {{{"listing", Rounding::listing}, {"none", Rounding::none}}};
}
Words<BallKind> words_of(BallKind) {
  return {{{"rings", BallKind::rings}, {"disc", BallKind::disc}}};
}
Words<Contact, 3> words_of(Contact) {
  return {{{"listing", Contact::listing},
           {"resolved", Contact::resolved},
           {"located", Contact::located}}};
}
Words<Rest> words_of(Rest) { return {{{"listing", Rest::listing}, {"geometry", Rest::geometry}}}; }

template <class Choice>
requires std::is_enum_v<Choice>
bool read(const toml::node& node, Choice& out) {
  for (const auto& [word, choice] : words_of(out)) {
    if (node.value_exact<std::string>() == word) {
      out = choice;
      return true;
    }
  }
  return false;
}
template <class Choice>
requires std::is_enum_v<Choice> std::string write(Choice value) {
  for (const auto& [word, choice] : words_of(value)) {
    if (choice == value) return write(std::string(word));
  }
  return "";
}
template <class Choice>
requires std::is_enum_v<Choice> std::string allowed_for(Choice value) {
  std::string text;
  const auto words = words_of(value);
  for (std::size_t i = 0; i < words.size(); ++i) {
    text += i == 0 ? "" : i + 1 < words.size() ? ", " : " or ";
    text += fmt::format("\"{}\"", words[i].first);
  }
  return text;
}

// A key for what `member` refers to in its owner.
template <class Owner, class Member>
Key<Owner> key(std::string table, std::string name, std::string note, Member member) {
  Owner example;
  return {std::move(table),
          std::move(name),
          std::move(note),
          allowed_for(member(example)),
          [member](const toml::node& node, Owner& owner) { return read(node, member(owner)); },
          [member](const Owner& owner) {
            Owner copy = owner;  // member() gives a reference to write through
            return write(member(copy));
          }};
}

template <class Member>
Key<Scene> scene_key(std::string table, std::string name, std::string note, Member member) {
  return key<Scene>(std::move(table), std::move(name), std::move(note), member);
}
// A key that is written of balls of one kind only.
Key<Scene> only_for(BallKind kind, Key<Scene> key) {
  key.write = [kind, write = std::move(key.write)](const Scene& scene) {
    return scene.ball.kind == kind ? write(scene) : std::string();
  };
  return key;
}
template <class Member>
Key<Wall> wall_key(std::string name, std::string note, Member member) {
  return key<Wall>("wall", std::move(name), std::move(note), member);
}

}  // namespace

const std::vector<Key<Scene>>& scene_keys() {
  static const std::vector<Key<Scene>> keys = {
      scene_key(
          "", "title", "", [](Scene & s) -> auto& { return s.title; }),
      scene_key(
          "", "constants", "precision of E, E R0^2, g and the step as stored",
          [](Scene & s) -> auto& { return s.constants; }),
      scene_key(
          "ball", "kind", "rings, or a filled disc",
          [](Scene & s) -> auto& { return s.ball.kind; }),
      scene_key(
          "ball", "radii", "cm", [](Scene & s) -> auto& { return s.ball.radii; }),
      only_for(BallKind::rings,
               scene_key(
                   "ball", "per_ring", "", [](Scene & s) -> auto& { return s.ball.per_ring; })),
      scene_key(
          "ball", "spacing", "cm, of a disc", [](Scene & s) -> auto& { return s.ball.spacing; }),
      scene_key(
          "ball", "centre", "cm", [](Scene & s) -> auto& { return s.ball.centre; }),
      scene_key(
          "ball", "velocity", "cm/s", [](Scene & s) -> auto& { return s.ball.velocity; }),
      scene_key(
          "ball", "rounding", "of the start, to four decimals or not",
          [](Scene & s) -> auto& { return s.ball.rounding; }),
      scene_key(
          "law", "p", "force -G/R^p + H/R^q", [](Scene & s) -> auto& { return s.law.p; }),
      scene_key(
          "law", "q", "", [](Scene & s) -> auto& { return s.law.q; }),
      scene_key(
          "law", "elasticity", "E = G; H = E R0^(q-p)",
          [](Scene & s) -> auto& { return s.law.elasticity; }),
      scene_key(
          "law", "rest", "where R0 comes from", [](Scene & s) -> auto& { return s.law.rest; }),
      scene_key(
          "gravity", "acceleration", "cm/s^2", [](Scene & s) -> auto& { return s.gravity; }),
      scene_key(
          "time", "step", "s", [](Scene & s) -> auto& { return s.time.step; }),
      scene_key(
          "time", "end", "s", [](Scene & s) -> auto& { return s.time.end; }),
      scene_key(
          "time", "method", "", [](Scene & s) -> auto& { return s.time.method; }),
      scene_key(
          "output", "frames_every", "s", [](Scene & s) -> auto& { return s.output.frames_every; }),
      scene_key(
          "output", "frames_at", "s", [](Scene & s) -> auto& { return s.output.frames_at; }),
      scene_key(
          "output", "monitor_every", "s",
          [](Scene & s) -> auto& { return s.output.monitor_every; }),
  };
  return keys;
}

const std::vector<Key<Wall>>& wall_keys() {
  static const std::vector<Key<Wall>> keys = {
      wall_key(
          "normal", "unit; the ball stays where normal.x > offset",
          [](Wall & w) -> auto& { return w.normal; }),
      wall_key(
          "offset", "cm", [](Wall & w) -> auto& { return w.offset; }),
      wall_key(
          "alpha", "tangential speed kept: 0 (full friction) to 1 (frictionless)",
          [](Wall & w) -> auto& { return w.alpha; }),
      wall_key(
          "beta", "normal speed returned: -1 (elastic) to 0",
          [](Wall & w) -> auto& { return w.beta; }),
      wall_key(
          "contact",
          "listing: the paper's rule; resolved: its limit for small steps; located: that limit, "
          "each "
          "contact found to the method's order",
          [](Wall & w) -> auto& { return w.contact; }),
  };
  return keys;
}

std::string_view word_of(Contact contact) {
  for (const auto& [word, choice] : words_of(contact)) {
    if (choice == contact) return word;
  }
  return {};
}

std::optional<Contact> contact_of(std::string_view word) {
  for (const auto& [name, contact] : words_of(Contact{})) {
    if (name == word) return contact;
  }
  return {};
}

std::string contact_words() { return allowed_for(Contact{}); }

}  // namespace bounce
