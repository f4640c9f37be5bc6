// A run written down, so that it can go on after whatever ended it: the file `checkpoint` in the
// run's directory, and `checkpoint.before`, the one before it.
//
//   bounce checkpoint 1          text: the format's number
//   {"version": ..., ...}        text: what was run, filled up with blanks to whole words
//   ...                          64-bit words, little endian: all numbers that the run goes on from
//   number of words before this, checksum of all words before this
//
//  1. A checkpoint is whole or absent. It is written under a name made new and, from the run's
//     first second on, is on the disk before it is renamed: a power cut leaves the one before.
//  2. What the run has written to other files stays there. The checkpoint has their lengths at that
//     time; what was written later is cut off and written once more.
//  3. It is believed only if its checksum is right, and gone on with only by the program that wrote
//     it: another commit may round otherwise, or lay out its numbers otherwise.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "kernels/plan/plan.hpp"
#include "verify/watch/words.hpp"

namespace bounce {

/// What was run, as far as the scene does not say it.
struct RunSettings {
  std::string command;      ///< the command line
  std::string scene_name;   ///< built-in name or file
  std::string initial;      ///< file of the initial state, or ""
  std::string advice;       ///< what --error was answered with, or ""
  PlanRequest request;      ///< in a checkpoint: the kernel that ran
  std::string final_state;  ///< where --final-state goes, or ""
  bool listing_frames = false;
  bool ledger = false;
  bool quiet = false;
  std::vector<std::int64_t> resumed;  ///< steps from which it was gone on with
};

struct CheckpointHead {
  RunSettings settings;
  std::string version, commit;  ///< of the program
  std::int64_t step = 0;
  double time = 0.0;                   ///< s
  std::uint64_t scene = 0, start = 0;  ///< hash_of() and state_hash() of the initial state
};

struct Checkpoint {
  CheckpointHead head;
  std::vector<std::uint64_t> words;
};

/// Of all values of a scene but its end, which may be moved.
std::uint64_t hash_of(Scene scene);

/// Writes `folder`/checkpoint; the one that was there becomes checkpoint.before. `to_disk`: returns
/// once it is on the disk. Throws OutputError; the one that was there is then still there.
void write_checkpoint(const std::filesystem::path& folder, const CheckpointHead& head,
                      const std::function<void(WordWriter&)>& body, bool to_disk);

/// Reads the bytes of a checkpoint; `name` is what messages call it. Throws InputError with the
/// reason: foreign, newer, cut off, damaged, or of another program (which `any_commit` lets pass).
Checkpoint read_checkpoint(const std::string& bytes, const std::string& name, bool any_commit);

/// Makes the last two words of a checkpoint's bytes its number of words and its checksum; for
/// tests, which change what is before them. Nothing below two words.
void seal_checkpoint(std::string& bytes);

/// That of a run's directory; `before`: the one before it. Where the checkpoint is refused and the
/// one before it is whole, the message says how to take that.
Checkpoint load_checkpoint(const std::filesystem::path& folder, bool before, bool any_commit);

/// Removes both, or all but the last.
void remove_checkpoints(const std::filesystem::path& folder);
void remove_checkpoint_before(const std::filesystem::path& folder);

}  // namespace bounce
