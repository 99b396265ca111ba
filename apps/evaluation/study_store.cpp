// SPDX-License-Identifier: MIT
#include "apps/evaluation/study_store.h"

#include "base/error.h"

#include <sys/random.h>

namespace gn {
namespace {

constexpr std::string_view study_schema = R"(
CREATE TABLE participant (id INTEGER PRIMARY KEY, token TEXT NOT NULL UNIQUE, seed INTEGER NOT NULL, details TEXT NOT NULL,
                          begun TEXT NOT NULL DEFAULT CURRENT_TIMESTAMP);
CREATE TABLE answer (participant INTEGER NOT NULL REFERENCES participant (id), position INTEGER NOT NULL,
                     document TEXT NOT NULL, given TEXT NOT NULL DEFAULT CURRENT_TIMESTAMP,
                     PRIMARY KEY (participant, position)) WITHOUT ROWID;
)";

}  // namespace

StudyStore::StudyStore(const std::filesystem::path& path)
    : database_(path, "GnSt", 1, study_schema, Journal::write_ahead) {}

Participant StudyStore::begin(const std::string& token, std::uint64_t seed, const std::string& details) {
    database_.transaction([&] {
        database_.prepare("INSERT INTO participant (token, seed, details) VALUES (?, ?, ?)")
            .bind(1, token)
            .bind(2, static_cast<std::int64_t>(seed))
            .bind(3, details)
            .run();
    });
    return find(token).value();
}

std::optional<Participant> StudyStore::find(const std::string& token) {
    Statement statement = database_.prepare("SELECT id, seed, details FROM participant WHERE token = ?");
    statement.bind(1, token);
    if (!statement.step()) {
        return std::nullopt;
    }
    return Participant{statement.integer(0), static_cast<std::uint64_t>(statement.integer(1)), statement.text(2)};
}

std::vector<Participant> StudyStore::participants() {
    std::vector<Participant> found;
    Statement statement = database_.prepare("SELECT id, seed, details FROM participant ORDER BY id");
    while (statement.step()) {
        found.push_back({statement.integer(0), static_cast<std::uint64_t>(statement.integer(1)), statement.text(2)});
    }
    return found;
}

std::vector<std::string> StudyStore::answers(std::int64_t participant) {
    std::vector<std::string> found;
    Statement statement = database_.prepare("SELECT document FROM answer WHERE participant = ? ORDER BY position");
    statement.bind(1, participant);
    while (statement.step()) {
        found.push_back(statement.text(0));
    }
    return found;
}

bool StudyStore::add(std::int64_t participant, int position, const std::string& document) {
    bool added = false;
    database_.transaction([&] {
        Statement statement = database_.prepare(
            "INSERT OR IGNORE INTO answer (participant, position, document) SELECT ?1, ?2, ?3 "
            "WHERE (SELECT count(*) FROM answer WHERE participant = ?1) = ?2");
        statement.bind(1, participant).bind(2, position).bind(3, document).run();
        added = database_.changes() == 1;
    });
    return added;
}

std::string random_token() {
    unsigned char bytes[16];
    if (getrandom(bytes, sizeof bytes, 0) != static_cast<ssize_t>(sizeof bytes)) {
        fail("the system gives no random numbers");
    }
    std::string token;
    for (const unsigned char byte : bytes) {
        token += fmt::format("{:02x}", byte);
    }
    return token;
}

std::uint64_t random_seed() {
    // SQLite keeps signed numbers.
    std::uint64_t seed = 0;
    if (getrandom(&seed, sizeof seed, 0) != static_cast<ssize_t>(sizeof seed)) {
        fail("the system gives no random numbers");
    }
    return seed >> 1U;
}

}  // namespace gn
