// SPDX-License-Identifier: MIT
// SQLite behind two types: a file that survives the end of the program at any moment, and a statement.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace gn {

/// One SQL statement: bind from 1, step while it has rows, read columns from 0. Throws Error.
class Statement {
  public:
    Statement(sqlite3* database, std::string_view sql);
    Statement& bind(int index, std::string_view text);
    Statement& bind(int index, std::int64_t value);
    Statement& bind(int index, int value) { return bind(index, std::int64_t{value}); }
    Statement& bind(int index, double value);
    Statement& bind(int index, std::optional<double> value);
    /// True while there is a row.
    bool step();
    /// Steps to the end, and is ready to be bound again.
    void run();
    [[nodiscard]] std::string text(int column) const;
    [[nodiscard]] std::int64_t integer(int column) const;
    [[nodiscard]] double real(int column) const;
    [[nodiscard]] bool is_null(int column) const;

  private:
    struct Finalize {
        void operator()(sqlite3_stmt* statement) const;
    };
    sqlite3* database_;
    std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

/// How a file is written: by itself, so that it can lie on any file system; or with a log beside it while it is open, one flush a
/// commit, on a disk of this machine.
enum class Journal { rollback, write_ahead };

/// A file of tables. What a transaction has committed outlives the program and the machine's power.
class Database {
  public:
    /// `kind` tells files of one purpose from all others (four letters, kept in the file); `version` is that of its tables, which
    /// `schema` makes where the file is new. Throws Error naming the file where it is of another kind or version, or no database.
    Database(const std::filesystem::path& path, std::string_view kind, int version, std::string_view schema,
             Journal journal = Journal::rollback);
    /// An existing file of that kind, to read from. Throws Error.
    static Database existing(const std::filesystem::path& path, std::string_view kind, int version);

    Statement prepare(std::string_view sql) { return {database_.get(), sql}; }
    void execute(std::string_view sql);
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    /// Rows that the last statement changed.
    [[nodiscard]] int changes() const;

    /// All of what `body` writes, or, where it throws, nothing.
    template <class Body>
    void transaction(const Body& body) {
        execute("BEGIN IMMEDIATE");
        try {
            body();
            execute("COMMIT");
        } catch (...) {
            roll_back();
            throw;
        }
    }

  private:
    struct Close {
        void operator()(sqlite3* database) const;
    };
    Database() = default;
    void open(const std::filesystem::path& path, int flags);
    void check_kind(std::string_view kind, int version);
    void roll_back() noexcept;
    std::filesystem::path path_;
    std::unique_ptr<sqlite3, Close> database_;
};

}  // namespace gn
