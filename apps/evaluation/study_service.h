// SPDX-License-Identifier: MIT
// The study's requests and replies, without a socket: what a participant and the administrator may ask, and all that is refused.
#pragma once

#include "apps/evaluation/session.h"
#include "apps/evaluation/study_store.h"

#include <map>
#include <mutex>

namespace gn {

struct StudyRequest {
    std::string method, path, body, content_type, host;
    std::map<std::string, std::string> query;
};

struct StudyReply {
    int status = 200;
    std::string type = "application/json", body;
};

/// Pages as they are sent; the caller reads them from apps/report.
struct StudyPages {
    std::string participant, administrator;
};

class StudyService {
  public:
    /// `folder` holds study.json, the pictures and the answers. `admin_key`: whoever names it is the administrator. `hosts`: names
    /// by which the server may be called; a page of another name cannot reach it through a visitor's browser. Throws Error.
    StudyService(const std::filesystem::path& folder, std::string admin_key, StudyPages pages,
                 std::vector<std::string> hosts);
    /// Never throws: what goes wrong is a reply. May be called from several threads.
    StudyReply handle(const StudyRequest& request);

  private:
    StudyReply answer_to(const StudyRequest& request);
    StudyReply begin(const StudyRequest& request);
    StudyReply state(const Participant& participant);
    StudyReply take(const Participant& participant, const StudyRequest& request);
    StudyReply picture(const Participant& participant, const StudyRequest& request);
    StudyReply administrate(const StudyRequest& request);
    Participant participant_of(const StudyRequest& request, const std::string& token);
    Screen screen_of(const Participant& participant) const;

    std::filesystem::path folder_;
    StudyPlan plan_;
    StudyStore store_;
    std::string admin_key_;
    StudyPages pages_;
    std::vector<std::string> hosts_;
    std::mutex mutex_;
};

/// Of a request's body.
inline constexpr std::size_t most_body_bytes = 16 * 1024;
/// Who may begin: more is an attack, not a study.
inline constexpr std::size_t most_participants = 10'000;

}  // namespace gn
