// SPDX-License-Identifier: MIT
// Who takes part in a study, by a random token, and what they answered: each answer is on the disk before it is acknowledged.
#pragma once

#include "apps/evaluation/database.h"

#include <vector>

namespace gn {

struct Participant {
    std::int64_t id = 0;
    std::uint64_t seed = 0;  ///< all that is random for them comes from it, so that a restart changes nothing
    std::string details;     ///< JSON: the screen; no name, no address
};

class StudyStore {
  public:
    explicit StudyStore(const std::filesystem::path& path);
    /// `token` must be new. Throws Error.
    Participant begin(const std::string& token, std::uint64_t seed, const std::string& details);
    std::optional<Participant> find(const std::string& token);
    std::vector<Participant> participants();
    /// The documents of a participant's answers, in order, without a gap.
    std::vector<std::string> answers(std::int64_t participant);
    /// Adds the answer at a position, which must be the next; false where it is not, and then nothing is changed.
    bool add(std::int64_t participant, int position, const std::string& document);

  private:
    Database database_;
};

/// 128 bits of the system's own randomness as 32 hexadecimal digits. Throws Error.
std::string random_token();
std::uint64_t random_seed();

}  // namespace gn
