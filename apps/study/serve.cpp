// SPDX-License-Identifier: MIT
#include "apps/study/serve.h"

#include "apps/compare/publish.h"
#include "apps/evaluation/study_service.h"
#include "apps/output.h"
#include "apps/terminal.h"
#include "base/paths.h"

#include <httplib.h>

#include <chrono>
#include <thread>

namespace gn {
namespace {

constexpr int request_seconds = 10, most_threads = 8;

std::string page_of(const std::string& name) {
    const std::filesystem::path templates = data_root() / "apps" / "report";
    std::string page = read_text(templates / (name + ".html"));
    fill_in(page, "style", read_text(templates / "report.css") + read_text(templates / "study.css"));
    fill_in(page, "charts", read_text(templates / "elements.js") + read_text(templates / "charts.js"));
    fill_in(page, "script", read_text(templates / (name + ".js")));
    return page;
}

/// "[::1]" as it stands in an address.
std::string in_address(const std::string& host) {
    return host.find(':') == std::string::npos ? host : "[" + host + "]";
}

/// The names by which a browser may call the server. A server for other machines is called by names that it does not know.
std::vector<std::string> names_of(const StudyOptions& options, int port) {
    std::vector<std::string> names;
    for (const std::string& host :
         {in_address(options.host), std::string("127.0.0.1"), std::string("localhost"), std::string("[::1]")}) {
        names.push_back(fmt::format("{}:{}", host, port));
        if (port == 80) {
            names.push_back(host);
        }
    }
    for (const std::string& name : options.names) {
        names.push_back(name);
        names.push_back(fmt::format("{}:{}", name, port));
    }
    return names;
}

StudyRequest request_of(const httplib::Request& request) {
    StudyRequest asked{request.method,
                       request.path,
                       request.body,
                       request.get_header_value("Content-Type"),
                       request.get_header_value("Host"),
                       {}};
    for (const auto& [name, value] : request.params) {
        asked.query.emplace(name, value);
    }
    return asked;
}

void protect(httplib::Response& response) {
    response.set_header("Cache-Control", "no-store");
    response.set_header("X-Content-Type-Options", "nosniff");
    response.set_header("Referrer-Policy", "no-referrer");
    response.set_header("X-Frame-Options", "DENY");
    response.set_header(
        "Content-Security-Policy",
        "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src 'self' data: blob:; "
        "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
}

}  // namespace

int serve_study(const StudyOptions& options) {
    httplib::Server server;
    server.new_task_queue = [] { return new httplib::ThreadPool(most_threads); };
    server.set_payload_max_length(most_body_bytes);
    // A port that another server listens on is taken: sharing it, as the library would, sends each of them half of the answers.
    server.set_socket_options([](socket_t socket) {
        const int yes = 1;
        setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    server.set_read_timeout(request_seconds);
    server.set_write_timeout(request_seconds);
    server.set_keep_alive_timeout(2);
    // Bind first: the port is part of the server's names.
    const int port = options.port == 0                                 ? server.bind_to_any_port(options.host)
                     : server.bind_to_port(options.host, options.port) ? options.port
                                                                       : -1;
    if (port <= 0) {
        throw InputError(
            fmt::format("--host {} --port {}: cannot be listened on; another port, or 0 for any that is free",
                        options.host, options.port));
    }
    const std::string key = random_token();
    StudyService service(options.folder, key, {page_of("study"), page_of("study_admin")}, names_of(options, port));
    const auto handler = [&](const httplib::Request& request, httplib::Response& response) {
        const StudyReply reply = service.handle(request_of(request));
        response.status = reply.status;
        response.set_content(reply.body, reply.type);
        protect(response);
    };
    server.Get(".*", handler);
    server.Post(".*", handler);
    server.set_error_handler([](const httplib::Request&, httplib::Response& response) {
        if (response.body.empty()) {
            response.set_content("{\"error\": \"refused\"}", "application/json");
        }
        protect(response);
    });

    // Say where, then listen until somebody asks to stop.
    const std::string address = fmt::format("http://{}:{}", in_address(options.host), port);
    fmt::print("participants:   {}/\nadministrator:  {}/admin?key={}\n", address, address, key);
    if (options.host != "127.0.0.1" && options.host != "localhost" && options.host != "::1") {
        fmt::print("This address is open to other machines, without encryption; put a proxy with TLS before it.\n");
        fmt::print("Others may call it {}.\n", options.names.empty()
                                                   ? "by no name yet: --name gives one"
                                                   : fmt::format("{}", fmt::join(options.names, ", ")));
    }
    std::fflush(stdout);
    watch_signals();
    std::thread watcher([&] {
        while (!stop_requested()) {
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
        server.stop();
    });
    const bool listened = server.listen_after_bind();
    const bool asked = stop_requested();
    if (!asked) {
        std::raise(SIGTERM);  // ends the watcher where listening failed by itself
    }
    watcher.join();
    if (!listened && !asked) {
        fail("the server stopped listening; every answer that was acknowledged is kept");
    }
    return exit_done;
}

}  // namespace gn
