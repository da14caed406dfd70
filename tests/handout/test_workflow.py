"""GitHub Actions: the workflow that grades students' repositories, its steps run as Actions runs them.

Steps that use an action are replaced by what it leaves behind (a copy of the repository), GitHub's API by a server here.
"""

import json
import os
import re
import shutil
import subprocess
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import nbformat
import pytest
import yaml
from markdown_it import MarkdownIt
from support import NAMES, ROOT, points
from transform_lab.judging.verdict import Verdict

from autograder.grading.judge import Row
from autograder.grading.one_student import markdown

WORKFLOWS = ROOT / ".github" / "workflows"
CHECK = yaml.safe_load((WORKFLOWS / "check.yml").read_text())
NASTY = "| <script>alert(1)</script> `code` | [a](javascript:b) **bold** \\\\| @everybody"


def steps(job):
    return CHECK["jobs"][job]["steps"]


def table(text):
    """[[cell, …], …] of the one table in a text that GitHub shows, without its head; HTML in cells is kept."""
    html = MarkdownIt("commonmark").enable("table").render(text)
    body = re.fullmatch(r".*<tbody>(.*)</tbody>.*", html, re.DOTALL)[1]
    return [re.findall(r"<td>(.*?)</td>", row, re.DOTALL) for row in body.split("</tr>")[:-1]]


class GitHub:
    """Answers like GitHub's API: {path: JSON or None for "nothing there"}; keeps what is posted."""

    def __init__(self, answers):
        self.posted = posted = {}

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self):
                found = answers.get(self.path)
                self.send_response(409 if found is None else 200)
                self.end_headers()
                self.wfile.write(json.dumps(found).encode())

            def do_POST(self):
                body = self.rfile.read(int(self.headers["Content-Length"]))
                posted[self.path] = self.headers["Authorization"], json.loads(body)
                self.send_response(201)
                self.end_headers()

            def log_message(self, *_):
                """Say nothing."""

        self.server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.address = f"http://127.0.0.1:{self.server.server_port}"

    def __enter__(self):
        threading.Thread(target=self.server.serve_forever, daemon=True).start()
        return self

    def __exit__(self, *_):
        self.server.shutdown()
        self.server.server_close()


def run_job(job, workspace, expressions, address):
    """Run a job's `run:` steps in a folder, up to the first that fails; (its exit code, the summary, {outputs}).

    expressions: {what stands between ${{ and }}: its value}; steps' outputs are added
    """
    temporary = workspace.parent / f"{workspace.name}-temporary"
    temporary.mkdir()
    summary, output = temporary / "summary", temporary / "output"
    environment = {
        **os.environ, "CI": "true", "GITHUB_ACTIONS": "true", "GITHUB_WORKSPACE": str(workspace),
        "GITHUB_STEP_SUMMARY": str(summary), "GITHUB_OUTPUT": str(output), "RUNNER_TEMP": str(temporary),
        "GITHUB_REPOSITORY_OWNER": "school", "GITHUB_API_URL": address,
    }  # fmt: skip
    summary.touch()
    outputs, code = {}, 0
    for step in (step for step in steps(job) if "run" in step):
        output.write_text("")
        given = {name: re.sub(r"\$\{\{ (.+?) \}\}", lambda found: expressions[found[1]], value)
                 for name, value in step.get("env", {}).items()}  # fmt: skip
        result = subprocess.run(
            ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", step["run"]],  # as Actions does for `shell: bash`
            cwd=workspace, env={**environment, **given}, capture_output=True, text=True, timeout=300,
        )  # fmt: skip
        code = result.returncode
        print(result.stdout + result.stderr)
        for line in output.read_text().splitlines():
            name, _, outputs[name] = line.partition("=")
            expressions = {**expressions, f"steps.{step['id']}.outputs.{name}": outputs[name]}
        if code:
            break
    return code, summary.read_text(), outputs


def test_only_staff_decide_what_runs_and_no_job_keeps_a_token():
    triggers = CHECK[True]  # YAML reads `on` as true
    assert set(triggers) == {"schedule", "workflow_dispatch"}  # nothing that a student's push or pull request starts
    assert CHECK["permissions"] == {"contents": "read"}
    assert CHECK["defaults"]["run"]["shell"] == "bash"
    for job in CHECK["jobs"].values():
        assert re.fullmatch(r"ubuntu-\w+", job["runs-on"])
        for step in job["steps"]:
            assert "${{" not in step.get("run", "")  # a repository's name is no program
            if step.get("uses", "").startswith("actions/checkout"):
                assert step["with"]["persist-credentials"] is False
            if "autograder" in step.get("run", ""):
                assert "env" not in step
    token = next(step for step in steps("grade") if step.get("id") == "token")
    assert token["with"]["repositories"] == "${{ matrix.name }}"


def test_actions_are_those_of_one_commit_each():
    """A tag may be moved to another commit; behind it, in a comment, stands which release the commit is."""
    pinned = re.compile(r"actions/[\w-]+@[0-9a-f]{40} # v\d+\.\d+\.\d+")
    used = [
        line.partition("uses:")[2].strip()
        for path in sorted(WORKFLOWS.iterdir())
        for line in path.read_text().splitlines()
        if "uses:" in line
    ]
    assert len(used) > 5 and not [each for each in used if not pinned.fullmatch(each)]
    assert len(set(used)) == len({each.partition("@")[0] for each in used})  # one release of each, everywhere


def test_ci_calls_the_same_script_as_everywhere():
    ci = yaml.safe_load((WORKFLOWS / "ci.yml").read_text())
    called = {name: [step["run"] for step in job["steps"] if "run" in step] for name, job in ci["jobs"].items()}
    assert called == {"quick": ["python3 -m autograder test"], "all": ['sudo env "PATH=$PATH" .ci/run']}
    assert (ROOT / ".ci/run").read_text().endswith("\nexport CI=true\nexec python3 -m autograder test --all\n")


def test_repositories_with_a_commit_that_was_not_graded_are_found(tmp_path):
    workspace = tmp_path / "course"
    workspace.mkdir()
    names = [
        "course",
        *(f"other-{number}" for number in range(99)),
        "transforms-ann",
        "transforms-ben",
        "transforms-cy",
    ]
    pages = [[{"name": name} for name in names[start : start + 100]] for start in (0, 100)]
    ours, theirs = {"app": {"slug": "grader"}}, {"app": {"slug": "github-actions"}}
    answers = {
        f"/installation/repositories?per_page=100&page={number}": {"repositories": page}
        for number, page in enumerate(pages, 1)
    }
    for name, commit, runs in (("ann", "a1", [ours]), ("ben", "b2", [theirs])):  # cy has pushed nothing
        answers[f"/repos/school/transforms-{name}/commits/HEAD"] = {"sha": commit}
        answers[f"/repos/school/transforms-{name}/commits/{commit}/check-runs?check_name=points"] = {"check_runs": runs}
    expressions = {
        "steps.token.outputs.token": "t", "steps.token.outputs.app-slug": "grader", "vars.STUDENTS": "transforms-",
    }  # fmt: skip
    with GitHub(answers) as github:
        code, _, outputs = run_job("find", workspace, expressions, github.address)
    assert code == 0
    assert json.loads(outputs["new"]) == [{"name": "transforms-ben", "commit": "b2"}]


@pytest.mark.parametrize("kind", ["solved", "half done"])
def test_a_students_repository_is_graded_and_told(kind, course, solved, sandboxed):
    workspace = course.root
    shutil.copytree(course.release, workspace / "student")
    given = solved if kind == "solved" else {"1_rotation": solved["1_rotation"]}
    for name, path in given.items():
        shutil.copy(path, workspace / "student")
    if kind == "half done":
        (workspace / "student" / "5_pre_grasp.ipynb").unlink()
        link = workspace / "student" / "3_chaining.ipynb"  # to the solutions, if it were followed
        link.unlink()
        link.symlink_to("../source/transforms/3_chaining.ipynb")
        path = workspace / "student" / "4_inversion.ipynb"
        notebook = nbformat.read(path, as_version=4)
        for cell in notebook.cells:
            if cell.metadata.get("nbgrader", {}).get("grade_id") == "invert_transform-solution":
                cell.source = f"def invert_transform(matrix):\n    raise ValueError({NASTY!r})"
        nbformat.write(notebook, path)
    expressions = {"steps.token.outputs.token": "t", "matrix.name": "transforms-ann", "matrix.commit": "a1"}
    with GitHub({}) as github:
        code, summary, _ = run_job("grade", workspace, expressions, github.address)
    assert code == 0
    rows = table(summary)
    assert [row[1] for row in rows] == NAMES and {len(row) for row in rows} == {4}
    ((path, (authorization, told)),) = github.posted.items()
    assert path == "/repos/school/transforms-ann/check-runs" and authorization == "Bearer t"
    assert told["head_sha"] == "a1" and told["output"]["summary"] == summary
    if kind == "solved":
        assert told["conclusion"] == "success" and told["output"]["title"] == f"{points():g} of {points():g} points"
        assert {row[3] for row in rows} == {""}
    else:
        assert (
            told["conclusion"] == "failure"
            and told["output"]["title"] == f"{points('1_rotation'):g} of {points():g} points"
        )
        words = {row[1]: row[3] for row in rows}
        assert (
            words["chain"] == "The file could not be read."
            and words["waypoint"] == "There is no 5_pre_grasp.ipynb to grade."
        )
        assert "&lt;script&gt;alert(1)&lt;/script&gt; `code` | [a](javascript:b) **bold**" in words["invert_transform"]
        assert "3&#95;chaining&#46;ipynb&#58; left out&#59; it is a link&#46;" in summary


def test_a_job_in_which_nothing_could_be_graded_fails_and_tells_nobody(course, slow):
    workspace = course.root
    shutil.rmtree(workspace / "notebooks")
    (workspace / "student").mkdir()
    with GitHub({}) as github:
        code, summary, _ = run_job("grade", workspace, {"steps.token.outputs.token": "t"}, github.address)
    assert code != 0 and summary == "" and not github.posted


def test_what_students_write_is_shown_as_it_is():
    row = Row("1_rotation", "is_rotation", 0.5, 2.0, "graded")
    verdict = Verdict("is_rotation", says=f"{NASTY} # Head | a | b |")
    text = markdown([(row, verdict)], ["<img src=x> *one* of\n- two", "x" * 5000])
    ((*_, points, says),) = table(text)
    assert points == "0.5 of 2"
    assert says.startswith(
        "| &lt;script&gt;alert(1)&lt;/script&gt; `code` | [a](javascript:b) **bold** \\\\| @everybody # Head"
    )
    html = MarkdownIt("commonmark").enable("table").render(text)
    assert "<li>&lt;img src=x&gt; *one* of - two</li>" in html
    assert not re.search(r"<(script|img|a|em|h1|code)\b", html) and html.count("<strong>") == 1
    assert "x" * 301 not in html
