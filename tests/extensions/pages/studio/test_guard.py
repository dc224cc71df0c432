"""Who may ask the studio: every attack of the list is tried on a server that runs."""

import contextlib
import json
import re
import socket
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from extensions.pages.studio.serving import Served, question, serving
from roadproof.errors import InputError, Position, RoadproofError
from roadproof.extensions.pages.places import FormulaPlace
from roadproof.extensions.pages.studio import jobs
from roadproof.extensions.pages.studio.drafting import QUESTION
from roadproof.extensions.pages.studio.dropping import drop
from roadproof.extensions.pages.studio.pages import read_start_files, static_files
from roadproof.extensions.pages.studio.requests import form, read_question
from roadproof.extensions.pages.studio.showing import marks_of
from roadproof.frontends.settings.questions import Witness
from roadproof.logic.formula import Truth

pytest.importorskip("uvicorn", reason="the extra 'studio' is not installed")


@pytest.fixture(scope="module")
def server() -> Iterator[Served]:
    with serving() as made:
        yield made


def test_the_page_of_this_start_is_answered(server: Served) -> None:
    assert server.get("/")[0] == 200
    assert server.post("/start", {})[0] == 200
    assert server.get("/", host=f"localhost:{server.port}")[0] == 200


@pytest.mark.parametrize(
    "host",
    [
        "evil.example",
        "127.0.0.1",
        "127.0.0.1:1",
        "localhost.evil.example:{port}",
        "127.0.0.1:{port}.evil.example",
    ],
)
def test_a_name_that_was_made_to_point_here_is_refused(server: Served, host: str) -> None:
    """DNS rebinding: the browser sends the other name as Host, with an origin that fits."""
    name = host.format(port=server.port)
    assert server.get("/", host=name)[0] == 403
    assert server.post("/start", {}, host=name, origin=f"http://{name}")[0] == 403


def test_a_request_without_host_or_with_two_is_refused(server: Served) -> None:
    assert server.get("/", host=None)[0] in (400, 403)
    twice = {**server.headers(), "Host": "evil.example"}
    assert server.send("GET / HTTP/1.1", twice)[0] in (400, 403)


@pytest.mark.parametrize(
    "origin", ["http://evil.example", "http://127.0.0.1:1", "null", "https://127.0.0.1:{port}"]
)
def test_another_origin_is_refused(server: Served, origin: str) -> None:
    name = origin.format(port=server.port)
    assert server.post("/start", {}, origin=name)[0] == 403
    assert server.get("/", origin=name)[0] == 403


def test_a_question_without_an_origin_is_refused(server: Served) -> None:
    assert server.post("/start", {}, origin=None)[0] == 403


def test_what_another_site_has_the_browser_fetch_is_refused(server: Served) -> None:
    assert server.get("/", sec_fetch_site="cross-site")[0] == 403
    assert server.get("/page/vendor/view.js", sec_fetch_site="same-site")[0] == 403


@pytest.mark.parametrize("token", [None, "", "the-toke", "the-token2", "the-tökén"])
def test_a_wrong_token_is_refused(server: Served, token: str | None) -> None:
    status, _, body = server.post("/start", {}, x_roadproof_token=token)
    assert status == 401
    assert b"the-token" not in body


def test_nothing_that_is_served_without_the_token_holds_it(server: Served) -> None:
    for path in ("/", *(f"/page/{name}" for name in static_files())):
        assert b"the-token" not in server.get(path)[2]


@pytest.mark.parametrize(
    "kind", [None, "text/plain", "application/x-www-form-urlencoded", "multipart/form-data"]
)
def test_forms_and_simple_requests_are_refused(server: Served, kind: str | None) -> None:
    """What a page of another site may send without asking first."""
    assert server.post("/start", {}, content_type=kind)[0] == 415


@pytest.mark.parametrize("method", ["PUT", "DELETE", "OPTIONS", "TRACE", "PATCH"])
def test_other_methods_are_refused(server: Served, method: str) -> None:
    assert server.send(f"{method} /ask HTTP/1.1", server.headers())[0] == 405


def test_questions_are_not_asked_with_get(server: Served) -> None:
    assert server.get("/ask?kind=find")[0] == 405
    assert server.get("/start")[0] == 405


def test_a_body_that_says_its_size_is_refused_where_it_is_too_large(server: Served) -> None:
    """At once, before it is sent."""
    assert server.send("POST /ask HTTP/1.1", server.headers(content_length="100001"))[0] == 413


def test_a_chunked_body_is_counted_while_it_is_read(server: Served) -> None:
    """It says no size; the server ends reading long before the sender would be done."""
    headers = server.headers(transfer_encoding="chunked")
    lines = ["POST /ask HTTP/1.1", *(f"{name}: {value}" for name, value in headers.items()), "", ""]
    chunk = b"2710\r\n" + b" " * 10_000 + b"\r\n"
    with socket.create_connection(("127.0.0.1", server.port), timeout=30) as connection:
        connection.sendall("\r\n".join(lines).encode())
        sent = 0
        try:
            for _ in range(10_000):
                connection.sendall(chunk)
                sent += 1
        except OSError:
            pass
        try:
            answer = connection.recv(65536)
        except ConnectionError:
            answer = b""
    assert sent < 10_000
    assert not answer or answer.split()[1] == b"413"


def test_a_small_chunked_body_is_read(server: Served) -> None:
    headers = server.headers(transfer_encoding="chunked")
    status, _, body = server.send("POST /ask HTTP/1.1", headers, b"2\r\n{}\r\n0\r\n\r\n")
    assert (status, body) == (400, b'{"error": "unknown kind of request"}')


@pytest.mark.parametrize("body", [b"", b"{", b"[]", b'"text"', b"[" * 50_000, b"\xff\xfe"])
def test_what_is_no_json_object_is_refused(server: Served, body: bytes) -> None:
    headers = server.headers(content_length=str(len(body)))
    assert server.send("POST /ask HTTP/1.1", headers, body)[0] == 400


@pytest.mark.parametrize("kind", ["import", "__class__", "", None, 3, ["find"], {"find": 1}])
def test_only_questions_of_the_list_are_asked(server: Served, kind: object) -> None:
    assert server.post("/ask", {"kind": kind})[0] == 400


@pytest.mark.parametrize(
    "path",
    [
        *("/page/../server.py", "/page/..%2fserver.py", "/page/%2e%2e/%2e%2e/errors.py", "/page//etc/passwd"),
        *("/page/index.html", "/../../etc/passwd", "/page/studio/app.js%00.css", "/page/studio/app.js/"),
        *("/studio/server.py", "/.git/config", "/page/", "/page/vendor/package.json"),
    ],
)
def test_no_path_leads_to_a_file(server: Served, path: str) -> None:
    assert server.get(path)[0] == 404


def test_what_the_browser_may_do_is_said_with_every_answer(server: Served) -> None:
    status, heading, body = server.get("/")
    policy = next(line for line in heading.splitlines() if line.startswith("content-security-policy:"))
    assert status == 200
    assert "default-src 'none'" in policy
    assert "unsafe" not in policy
    assert "*" not in policy
    nonces = set(re.findall(r'nonce="([^"]+)"', body.decode()))
    assert len(nonces) == 1
    assert f"'nonce-{nonces.pop().lower()}'" in policy
    for path in ("/page/studio/app.js", "/nothing"):
        assert "content-security-policy: " in server.get(path)[1]
    for answer in (
        server.get("/"),
        server.get("/page/viewer.css"),
        server.post("/start", {}),
        server.get("/ask"),
    ):
        assert "x-content-type-options: nosniff" in answer[1]
        assert "access-control-allow" not in answer[1]


def test_two_pages_have_different_nonces(server: Served) -> None:
    first, second = (re.findall(r'nonce="([^"]+)"', server.get("/")[2].decode())[0] for _ in range(2))
    assert first != second


def test_own_scripts_make_no_code_of_texts() -> None:
    """No eval, no function made of text, no HTML made of text; the policy forbids the first two anyway."""
    wanted = re.compile(r"\beval\(|new Function|innerHTML|outerHTML|insertAdjacentHTML|document\.write")
    own = {name: x.text for name, x in static_files().items() if not name.startswith("vendor/")}
    assert len(own) > 10
    assert [name for name, text in own.items() if wanted.search(text)] == []
    vendored = {name: x.text for name, x in static_files().items() if name.startswith("vendor/")}
    assert [n for n, text in vendored.items() if re.search(r"\beval\(|new Function\(", text)] == []


@pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
def test_only_the_loopback_interface_listens(server: Served) -> None:
    """127.0.0.1 alone: every other address of this machine refuses, where its name has any."""
    found = []
    with contextlib.suppress(socket.gaierror):
        found = socket.getaddrinfo(socket.gethostname(), None)
    for address in {"127.0.0.2", *(x[4][0] for x in found)} - {"127.0.0.1", "::1"}:
        with pytest.raises(OSError, match=r".*"):
            socket.create_connection((address, server.port), timeout=1)
    assert listening_addresses(server.port) == {"127.0.0.1"}


def listening_addresses(port: int) -> set[str]:
    """Where something listens on a port, as Linux tells it."""
    with open("/proc/net/tcp", encoding="ascii") as file:
        rows = [line.split() for line in file.readlines()[1:]]
    here = [row[1].split(":") for row in rows if row[3] == "0A"]
    return {
        ".".join(str(x) for x in reversed(bytes.fromhex(address)))
        for address, at in here
        if int(at, 16) == port
    }


def test_a_question_waits_where_no_worker_is_there_and_the_queue_says_when_it_is_full(server: Served) -> None:
    """Nine waiters on a server whose queue takes eight."""
    body = json.dumps({"kind": "find", **question()}).encode()
    head = "\r\n".join(
        [
            "POST /ask HTTP/1.1",
            *(f"{k}: {v}" for k, v in server.headers(content_length=str(len(body))).items()),
            "",
            "",
        ]
    )
    waiting = [socket.create_connection(("127.0.0.1", server.port), timeout=30) for _ in range(8)]
    for connection in waiting:
        connection.sendall(head.encode() + body)
        answer = b""
        while b"waiting" not in answer:
            answer += connection.recv(4096)
    _, _, told = server.post("/ask", {"kind": "find", **question()})
    assert b"the queue is full" in told
    for connection in waiting:
        connection.close()


# --- What the studio opens and what is dropped on it, without a browser -----------------------------

EXAMPLES = Path(__file__).parents[4] / "examples"
DRIVE = EXAMPLES / "catalogue" / "tests" / "drives" / "braking.json"
SAMPLES = EXAMPLES / "catalogue" / "tests" / "samples"


def test_specifications_and_drives_are_opened_by_their_endings(tmp_path: Path) -> None:
    spec = tmp_path / "own.spec"
    spec.write_text('def near(a, b: vehicle) "near" := s(b) - s(a) <= 5 m\n', "utf-8")
    found = read_start_files([spec, DRIVE])
    assert found.text == spec.read_text("utf-8")
    assert found.drives == ((DRIVE.name, json.loads(DRIVE.read_text("utf-8"))),)
    with pytest.raises(InputError, match=r"own\.txt: the studio opens"):
        read_start_files([spec, tmp_path / "own.txt"])


def test_samples_recordings_and_certificates_of_the_command_line_are_opened_by_the_page(
    tmp_path: Path,
) -> None:
    proof = next((EXAMPLES.parent / "proofs").glob("P4-*.json"))
    samples = SAMPLES / "braking.csv"
    found = read_start_files([samples, DRIVE, proof])
    assert [x["name"] for x in found.as_data()["files"]] == [samples.name, proof.name]  # type: ignore[attr-defined]
    assert dict(found.files)[samples.name] == samples.read_text("utf-8")
    assert [name for name, _ in found.drives] == [DRIVE.name]
    assert read_start_files([SAMPLES]).files == ()
    (tmp_path / "own.csv").write_bytes(b"\xff\xfe")
    with pytest.raises(InputError, match=r"own\.csv: the file is text in UTF-16|own\.csv is not UTF-8 text"):
        read_start_files([tmp_path / "own.csv"])


def dropped(*paths: Path) -> dict[str, Any]:
    files = [{"name": x.name, "content": x.read_text("utf-8")} for x in paths]
    draft = {"base": "base", "text": "", "options": {}, "params": {}}
    asked = {"draft": draft, "set": "base", "formula": "scenario_4(SV,POV,L)", "files": files}
    return drop(read_question(asked))


def test_a_drive_is_shown_and_samples_are_monitored() -> None:
    assert dropped(DRIVE)["drive"]["schema"].startswith("roadproof/drive/")
    found = dropped(SAMPLES / "braking.csv")
    assert [x["role"] for x in found["view"]["formulas"]] == ["question"]


def test_the_form_of_the_page_follows_the_options_of_questions() -> None:
    assert {(x["job"], x["name"], x["default"]) for x in form()} == {
        ("find", "objective", "typical"),
        ("prove", "declared", False),
    }
    [objective] = [x for x in form() if x["name"] == "objective"]
    assert objective["choices"] == Witness.options()["objective"].choices
    asked = {"draft": {}, "formula": "true", "settings": {"objective": "severe"}}
    assert read_question(asked).options("find") == {"objective": "severe"}


@pytest.mark.parametrize(
    ("asked", "told"),
    [
        ({"settings": {"declared": True}}, "declared=True: the page has no such option of find"),
        ({"settings": {"objective": 3}}, "objective=3: the page has no such option of find"),
        ({"settings": {"objective": "fast"}}, "objective='fast': write 'any' or 'smooth'"),
        ({"count": 13}, "count=13: ask for 1 to 12"),
        ({"formula": "x" * 200_001}, "formula has 200001 characters"),
        ({"more": 1}, "unknown field 'more'"),
        ({"scenarios": [*range(25)]}, "scenarios=25: at most 24 are shown at once"),
        ({"explain": {"part": 0, "at": 3601}}, "explain an instant from 0 to 3600 s"),
        ({"watches": ["true"] * 13}, "at most 12 formulas are watched"),
    ],
)
def test_questions_of_a_page_are_read_strictly(asked: dict[str, Any], told: str) -> None:
    with pytest.raises(RoadproofError, match=re.escape(told)):
        jobs.answer("find", {"draft": {}, "formula": "true", **asked})


def test_marks_are_of_places_in_the_texts_of_the_editors_alone() -> None:
    place = FormulaPlace(QUESTION, Position(1, 2, 1, 5), Truth(True))
    assert marks_of([place, place], "why") == [
        {"where": QUESTION, "from": [1, 2], "to": [1, 5], "kind": "why"}
    ]
    assert marks_of([replace(place, source="iso34502.spec")], "why") == []
