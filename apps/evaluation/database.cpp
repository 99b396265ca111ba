// SPDX-License-Identifier: MIT
#include "apps/evaluation/database.h"

#include "base/error.h"

#include <sqlite3.h>

namespace gn {
namespace {

/// Another process of ours may be writing; it never takes longer.
constexpr int patience_ms = 20'000;

int application_id(std::string_view kind) {
    GN_CHECK(kind.size() == 4);
    int id = 0;
    for (const char letter : kind) {
        id = id * 256 + letter;
    }
    return id;
}

[[noreturn]] void fail_of(sqlite3* database, const std::string& what) {
    fail("{}: {}", what, database != nullptr ? sqlite3_errmsg(database) : "out of memory");
}

std::string path_of(sqlite3* database) {
    const char* name = sqlite3_db_filename(database, "main");
    return name != nullptr ? name : "database";
}

}  // namespace

void Statement::Finalize::operator()(sqlite3_stmt* statement) const {
    sqlite3_finalize(statement);
}

Statement::Statement(sqlite3* database, std::string_view sql) : database_(database) {
    sqlite3_stmt* statement = nullptr;
    if (sqlite3_prepare_v2(database, sql.data(), static_cast<int>(sql.size()), &statement, nullptr) != SQLITE_OK) {
        fail_of(database, path_of(database));
    }
    statement_.reset(statement);
}

Statement& Statement::bind(int index, std::string_view text) {
    // An empty view may have no address, which SQLite would take for NULL.
    const char* data = text.empty() ? "" : text.data();
    GN_CHECK_EQ(sqlite3_bind_text(statement_.get(), index, data, static_cast<int>(text.size()), SQLITE_TRANSIENT), 0);
    return *this;
}

Statement& Statement::bind(int index, std::int64_t value) {
    GN_CHECK_EQ(sqlite3_bind_int64(statement_.get(), index, value), 0);
    return *this;
}

Statement& Statement::bind(int index, double value) {
    GN_CHECK_EQ(sqlite3_bind_double(statement_.get(), index, value), 0);
    return *this;
}

Statement& Statement::bind(int index, std::optional<double> value) {
    if (value) {
        return bind(index, *value);
    }
    GN_CHECK_EQ(sqlite3_bind_null(statement_.get(), index), 0);
    return *this;
}

bool Statement::step() {
    const int code = sqlite3_step(statement_.get());
    if (code != SQLITE_ROW && code != SQLITE_DONE) {
        const std::string sentence = path_of(database_) + ": " + sqlite3_errmsg(database_);
        sqlite3_reset(statement_.get());
        throw Error(sentence);
    }
    return code == SQLITE_ROW;
}

void Statement::run() {
    while (step()) {
    }
    sqlite3_reset(statement_.get());
}

std::string Statement::text(int column) const {
    const auto* bytes = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
    return bytes == nullptr
               ? std::string()
               : std::string(bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column)));
}

std::int64_t Statement::integer(int column) const {
    return sqlite3_column_int64(statement_.get(), column);
}

double Statement::real(int column) const {
    return sqlite3_column_double(statement_.get(), column);
}

bool Statement::is_null(int column) const {
    return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}

void Database::Close::operator()(sqlite3* database) const {
    sqlite3_close(database);
}

Database::Database(const std::filesystem::path& path, std::string_view kind, int version, std::string_view schema,
                   Journal journal) {
    open(path, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
    // A commit is on the disk before anybody is told of it.
    execute(journal == Journal::rollback ? "PRAGMA journal_mode = DELETE" : "PRAGMA journal_mode = WAL");
    execute("PRAGMA synchronous = FULL");
    // Make the tables of a new file, all or none of them.
    transaction([&] {
        Statement tables = prepare("SELECT count(*) FROM sqlite_master");
        tables.step();
        if (tables.integer(0) == 0) {
            execute(fmt::format("PRAGMA application_id = {}", application_id(kind)));
            execute(fmt::format("PRAGMA user_version = {}", version));
            execute(schema);
        }
    });
    check_kind(kind, version);
}

Database Database::existing(const std::filesystem::path& path, std::string_view kind, int version) {
    std::error_code code;
    if (!std::filesystem::is_regular_file(path, code)) {
        fail("{}: there is no such file", path.string());
    }
    Database database;
    database.open(path, SQLITE_OPEN_READWRITE);
    database.check_kind(kind, version);
    return database;
}

void Database::open(const std::filesystem::path& path, int flags) {
    path_ = path;
    sqlite3* database = nullptr;
    const int code = sqlite3_open_v2(path.c_str(), &database, flags | SQLITE_OPEN_FULLMUTEX, nullptr);
    database_.reset(database);
    if (code != SQLITE_OK) {
        fail_of(database, path.string());
    }
    sqlite3_busy_timeout(database, patience_ms);
}

void Database::check_kind(std::string_view kind, int version) {
    const auto value_of = [&](std::string_view pragma) {
        Statement statement = prepare(pragma);
        return statement.step() ? statement.integer(0) : 0;
    };
    if (value_of("PRAGMA application_id") != application_id(kind)) {
        fail("{}: is another program's database, or one of another command", path_.string());
    }
    if (const auto found = value_of("PRAGMA user_version"); found != version) {
        fail("{}: was written by another version of gnomon (tables {}, this one has {})", path_.string(), found,
             version);
    }
}

void Database::execute(std::string_view sql) {
    char* message = nullptr;
    if (sqlite3_exec(database_.get(), std::string(sql).c_str(), nullptr, nullptr, &message) != SQLITE_OK) {
        const std::string sentence = fmt::format("{}: {}", path_.string(), message != nullptr ? message : "failed");
        sqlite3_free(message);
        throw Error(sentence);
    }
}

int Database::changes() const {
    return sqlite3_changes(database_.get());
}

void Database::roll_back() noexcept {
    // Where there is none left to roll back, all is well too.
    sqlite3_exec(database_.get(), "ROLLBACK", nullptr, nullptr, nullptr);
}

}  // namespace gn
