"""GitHub Actions: the workflow that grades students' repositories, all its steps as Actions runs them.

They are taken from the YAML itself. Actions are replaced by what they do (a checkout, from a git server here), GitHub's API by
a server that takes no request but what github_api.json, an excerpt of GitHub's published description, describes.
"""

import json
import os
import re
import shutil
import subprocess
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from urllib.parse import parse_qs, unquote, urlsplit

import jsonschema
import nbformat
import pytest
import yaml
from markdown_it import MarkdownIt
from support import NAMES, ROOT, points
from transform_lab.judging.verdict import Verdict

from autograder.environment import OLDEST
from autograder.grading.judge import Row
from autograder.grading.one_student import markdown

WORKFLOWS = ROOT / ".github" / "workflows"
CHECK = yaml.safe_load((WORKFLOWS / "check.yml").read_text())
API = json.loads(Path(__file__).with_name("github_api.json").read_text())["paths"]
ORGANISATION, COURSE, APP = "school", "course", "grader"
NASTY = "| <script>alert(1)</script> `code` | [a](javascript:b) **bold** \\\\| @everybody"


def steps(job):
    return CHECK["jobs"][job]["steps"]


def table(text):
    """[[cell, …], …] of the one table in a text that GitHub shows, without its head; HTML in cells is kept."""
    html = MarkdownIt("commonmark").enable("table").render(text)
    body = re.fullmatch(r".*<tbody>(.*)</tbody>.*", html, re.DOTALL)[1]
    return [re.findall(r"<td>(.*?)</td>", row, re.DOTALL) for row in body.split("</tr>")[:-1]]


def git(folder, *arguments, **options):
    """What a git command prints, by somebody without settings of their own."""
    own = {"GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_SYSTEM": os.devnull}
    names = ("-c", "user.name=Ann", "-c", "user.email=ann@example.org", "-c", "init.defaultBranch=main")
    command = ["git", *names, *arguments]
    return subprocess.run(
        command, cwd=folder, env=os.environ | own, check=True, capture_output=True, text=True, **options
    ).stdout.strip()


class GitHub:
    """The repositories of an organisation, in bare ones below `folder`, and the part of the API that is described.

    runs: {name: [check runs, …]}; wrong: what was asked that is not as described
    """

    def __init__(self, folder):
        self.folder, self.runs, self.wrong = folder, {}, []
        github = self

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self):
                self.answer(*github.asked("get", self.path, self.headers, None))

            def do_POST(self):
                body = self.rfile.read(int(self.headers["Content-Length"]))
                self.answer(*github.asked("post", self.path, self.headers, body))

            def answer(self, code, content):
                self.send_response(code)
                self.send_header("Content-Type", "application/json; charset=utf-8")
                self.end_headers()
                self.wfile.write(json.dumps(content).encode())

            def log_message(self, *_):
                """Say nothing."""

        self.server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.address = f"http://127.0.0.1:{self.server.server_port}"

    def __enter__(self):
        threading.Thread(target=self.server.serve_forever, daemon=True).start()
        return self

    def __exit__(self, failed, *_):
        self.server.shutdown()
        self.server.server_close()
        assert failed or not self.wrong, self.wrong

    def push(self, name, files):
        """Commit a folder as all that a repository holds (None: it is new and empty); the commit's number."""
        bare = self.folder / f"{name}.git"
        if not bare.exists():
            git(self.folder, "init", "--bare", "--quiet", bare)
            git(bare, "config", "uploadpack.allowAnySHA1InWant", "true")  # GitHub serves any commit that is asked for
        if files is not None:
            place = ("--git-dir", bare, "--work-tree", files)
            git(files, *place, "add", "--all", "--force")
            git(files, *place, "commit", "--quiet", "--allow-empty", "--message", "Work")
        return self.newest(name)

    def newest(self, name):
        """The newest commit of a repository, or None."""
        try:
            return git(self.folder / f"{name}.git", "rev-parse", "--verify", "--quiet", "HEAD")
        except subprocess.CalledProcessError:
            return None

    def token(self, repositories=None):
        """What the app may use for these repositories, or for all."""
        return f"token of {','.join(repositories or ['all'])}"

    def asked(self, method, address, headers, body):
        """(status, JSON) for a request, which is compared with the description."""
        url = urlsplit(address)
        for path, methods in API.items():
            if method in methods and (found := re.fullmatch(re.sub(r"\{(\w+)\}", r"(?P<\1>[^/]+)", path), url.path)):
                break
        else:
            self.wrong.append(f"{method} {address}: not in the description")
            return 404, {"message": "Not Found"}
        described, place = methods[method], {name: unquote(text) for name, text in found.groupdict().items()}
        self.compare(described, address, parse_qs(url.query, strict_parsing=bool(url.query)), headers, body)
        scopes = [[place["repo"]], None] if "repo" in place else [None]
        if headers["Authorization"] not in [f"Bearer {self.token(scope)}" for scope in scopes]:
            return 401, {"message": "Bad credentials"}
        code, content = getattr(self, described["operationId"].replace("/", "_").replace("-", "_"))(
            described["example"], url.query, body and json.loads(body), **place
        )
        assert str(code) in described["responses"]
        return code, content

    def compare(self, described, address, query, headers, body):
        """Note what GitHub's description does not have."""
        known = {each["name"]: each["schema"] for each in described["parameters"] if each["in"] == "query"}
        for name, (value,) in query.items():
            if name not in known:
                self.wrong.append(f"{address}: no parameter {name}")
            elif known[name]["type"] == "integer" and not value.isdecimal():
                self.wrong.append(f"{address}: {name} is a number")
        if body is not None:
            schema, sent = described["requestBody"], json.loads(body)
            if headers["Content-Type"] != "application/json":
                self.wrong.append(f"{address}: {headers['Content-Type']}")
            closed = json.loads(
                json.dumps(schema), object_hook=_closed
            )  # GitHub overlooks a field that it does not know
            self.wrong += [
                f"{address}: {error.message}" for error in jsonschema.Draft7Validator(closed).iter_errors(sent)
            ]

    def apps_list_repos_accessible_to_installation(self, example, query, _):
        asked = {name: int(value) for name, (value,) in parse_qs(query).items()}
        size = min(asked.get("per_page", 30), 100)
        names = sorted(path.stem for path in self.folder.glob("*.git"))
        page = names[size * (asked.get("page", 1) - 1) :][:size]
        (repository,) = example["repositories"]
        listed = [repository | {"name": name, "full_name": f"{ORGANISATION}/{name}"} for name in page]
        return 200, example | {"total_count": len(names), "repositories": listed}

    def repos_get_commit(self, example, _, __, owner, repo, ref):
        assert (owner, ref) == (ORGANISATION, "HEAD")
        if commit := self.newest(repo):
            return 200, example | {"sha": commit}
        return 409, {"message": "Git Repository is empty.", "status": "409"}

    def checks_list_for_ref(self, example, query, _, owner, repo, ref):
        name = parse_qs(query).get("check_name")
        (run,) = example["check_runs"]
        found = [
            run | {"name": each["name"], "head_sha": ref, "app": run["app"] | {"slug": each.get("app", APP)}}
            for each in self.runs.get(repo, [])
            if each["head_sha"] == ref and name in (None, [each["name"]])
        ]
        return 200, example | {"total_count": len(found), "check_runs": found}

    def checks_create(self, example, _, sent, owner, repo):
        self.runs.setdefault(repo, []).append(sent)
        return 201, example | sent


def _closed(schema):
    return schema | {"additionalProperties": False} if schema.get("type") == "object" else schema


class Actions:
    """A run of the workflow. folder: where its jobs work, each in a folder of its own."""

    def __init__(self, github, folder):
        self.github, self.folder = github, folder
        self.summary = ""
        self.context = {
            "github": {"repository_owner": ORGANISATION, "repository": f"{ORGANISATION}/{COURSE}"},
            "vars": {"GRADER_CLIENT_ID": "Iv1.1", "STUDENTS": "transforms-"},
            "secrets": {"GRADER_PRIVATE_KEY": "key"},
            "needs": {},
        }

    def run(self):
        """Run the jobs one after the other, each for all of its matrix; [(name, whether it succeeded), …]."""
        done = []
        for name, job in CHECK["jobs"].items():
            if not self.value(job["if"], self.context):
                continue
            matrix = self.fill(job.get("strategy", {}).get("matrix", {}).get("include", ""), self.context)
            for chosen in json.loads(matrix) if matrix else [{}]:
                context = self.context | {"matrix": chosen, "steps": {}}
                done.append((self.fill(job.get("name", name), context), self.job(job, context)))
                outputs = {each: self.fill(text, context) for each, text in job.get("outputs", {}).items()}
                self.context["needs"][name] = {"outputs": outputs}
        return done

    def job(self, job, context):
        """Run the steps up to the first that fails, in a clean folder; whether none did."""
        number = len(list(self.folder.iterdir()))
        workspace, temporary = self.folder / f"{number}", self.folder / f"{number}-temporary"
        for folder in (workspace, temporary):
            folder.mkdir()
        try:
            for step in job["steps"]:
                given = {name: self.fill(text, context) for name, text in step.get("with", {}).items()}
                if "uses" in step:
                    action = re.fullmatch(r"actions/([\w-]+)@\w+", step["uses"])[1].replace("-", "_")
                    outputs = getattr(self, action)(
                        workspace, **{name.replace("-", "_"): given[name] for name in given}
                    )
                else:
                    outputs = self.command(step, workspace, temporary, context)
                context["steps"][step.get("id")] = {"outputs": outputs or {}}
            return True
        except subprocess.CalledProcessError as error:
            print(error.stdout, error.stderr)
            return False

    def command(self, step, workspace, temporary, context):
        """Run a `run:` step; its outputs."""
        summary, output = temporary / "summary", temporary / "output"
        inherited = {
            name: text for name, text in os.environ.items() if not name.startswith(("PYTHON", "PYTEST", "GIT"))
        }
        environment = {
            **inherited, "CI": "true", "GITHUB_ACTIONS": "true", "GITHUB_WORKSPACE": str(workspace),
            "GITHUB_STEP_SUMMARY": str(summary), "GITHUB_OUTPUT": str(output), "RUNNER_TEMP": str(temporary),
            "GITHUB_REPOSITORY": f"{ORGANISATION}/{COURSE}", "GITHUB_REPOSITORY_OWNER": ORGANISATION,
            "GITHUB_API_URL": self.github.address,
        }  # fmt: skip
        for path in (summary, output):
            path.write_text("")
        given = {name: self.fill(text, context) for name, text in step.get("env", {}).items()}
        ran = subprocess.run(
            ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", step["run"]],  # as Actions does for `shell: bash`
            cwd=workspace, env=environment | given, capture_output=True, text=True, timeout=600,
        )  # fmt: skip
        print(ran.stdout + ran.stderr)
        self.summary += summary.read_text()
        ran.check_returncode()
        return dict(line.split("=", 1) for line in output.read_text().splitlines())

    def checkout(self, workspace, repository=f"{ORGANISATION}/{COURSE}", ref="HEAD", path=".", token=None, **_):
        owner, name = repository.split("/")
        assert owner == ORGANISATION and (name == COURSE or token == self.github.token([name]))
        target = workspace / path
        git(workspace, "init", "--quiet", target)
        git(target, "fetch", "--quiet", "--depth=1", (self.github.folder / f"{name}.git").as_uri(), ref)
        git(target, "checkout", "--quiet", "--detach", "FETCH_HEAD")

    def setup_python(self, workspace, python_version):
        assert tuple(map(int, python_version.split("."))) >= OLDEST  # the tests' own is used

    def create_github_app_token(self, workspace, client_id, private_key, owner, repositories=None):
        assert (client_id, private_key, owner) == ("Iv1.1", "key", ORGANISATION)
        return {"token": self.github.token(repositories and [repositories]), "app-slug": APP}

    def fill(self, text, context):
        """A text of the YAML with what its expressions give."""
        return re.sub(r"\$\{\{ (.+?) \}\}", lambda found: self.value(found[1], context), str(text))

    def value(self, expression, context):
        """What an expression gives; of Actions' language it may use names, &&, !=, strings and fromJSON."""

        def looked_up(found):
            value = context
            for name in found[0].split("."):
                value = value.get(name, "")
            return repr(value)

        expression = re.sub(r"\b(?:github|vars|secrets|steps|needs|matrix)\.[\w.-]+", looked_up, expression)
        return eval(expression.replace("&&", "and"), {"fromJSON": lambda text: text})


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


def test_ci_begins_in_a_clone(course_files, tmp_path, slow):
    """Its first job, with one file of tests: it needs nothing but what is committed."""
    with GitHub(tmp_path) as github:
        github.push(COURSE, course_files)
        (tmp_path / "clone").mkdir()
        actions = Actions(github, tmp_path)
        actions.checkout(tmp_path / "clone")
        (tmp_path / "temporary").mkdir()
        for step in yaml.safe_load((WORKFLOWS / "ci.yml").read_text())["jobs"]["quick"]["steps"]:
            if "run" in step:
                one_file = step | {"env": {"PYTEST_ADDOPTS": "--numprocesses=0 tests/test_names.py"}}
                actions.command(one_file, tmp_path / "clone", tmp_path / "temporary", {})


# --- students' repositories -----------------------------------------------------------------------------------------


@pytest.fixture
def course_files(tmp_path_factory):
    """A folder with what is committed of this course, or would be."""
    folder = tmp_path_factory.mktemp("committed")
    for name in git(ROOT, "ls-files", "--cached", "--others", "--exclude-standard").splitlines():
        if (path := ROOT / name).is_file() and not path.is_symlink():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, folder / name)
    return folder


@pytest.fixture
def github(tmp_path_factory):
    with GitHub(tmp_path_factory.mktemp("github")) as running:
        yield running


@pytest.fixture
def actions(github, tmp_path_factory):
    """actions(): a run of the workflow, from its first step to its last."""
    return lambda: Actions(github, tmp_path_factory.mktemp("run"))


@pytest.fixture
def work(tmp_path, course):
    """work(name, files): a student's folder, the released notebooks and over them {name: path}."""

    def make(name, files):
        folder = shutil.copytree(course.release, tmp_path / name)
        for path in files.values():
            shutil.copy(path, folder)
        return folder

    return make


def test_repositories_with_a_commit_that_was_not_graded_are_found(github, actions, tmp_path, slow):
    (tmp_path / "file").mkdir()
    (tmp_path / "file" / "1_rotation.ipynb").write_text("{}")
    for number in range(100):
        github.push(f"other-{number}", None)  # so that there are two pages of repositories
    commits = {name: github.push(f"transforms-{name}", tmp_path / "file") for name in ("ann", "ben", "dee")}
    earlier, commits["dee"] = commits["dee"], github.push("transforms-dee", tmp_path / "file")
    github.push("transforms-cy", None)  # who has pushed nothing
    checked = {"name": "points", "status": "completed", "conclusion": "success"}
    github.runs["transforms-ann"] = [checked | {"head_sha": commits["ann"]}]
    github.runs["transforms-ben"] = [checked | {"head_sha": commits["ben"], "app": "github-actions"}]  # said by others
    github.runs["transforms-dee"] = [checked | {"head_sha": earlier}]
    found = actions()
    job, context = CHECK["jobs"]["find"], found.context | {"steps": {}}
    assert found.value(job["if"], found.context) and found.job(job, context)
    assert json.loads(found.fill(job["outputs"]["new"], context)) == [
        {"name": f"transforms-{name}", "commit": commits[name]} for name in ("ben", "dee")
    ]


def test_students_repositories_are_graded_and_told_once(github, actions, work, course_files, solved, sandboxed):
    github.push(COURSE, course_files)
    ann = work("ann", solved)
    ben = work("ben", {"1_rotation": solved["1_rotation"]})
    (ben / "5_pre_grasp.ipynb").unlink()
    link = ben / "3_chaining.ipynb"  # to the solutions, if it were followed
    link.unlink()
    link.symlink_to("../source/transforms/3_chaining.ipynb")
    path = ben / "4_inversion.ipynb"
    notebook = nbformat.read(path, as_version=4)
    for cell in notebook.cells:
        if cell.metadata.get("nbgrader", {}).get("grade_id") == "invert_transform-solution":
            cell.source = f"def invert_transform(matrix):\n    raise ValueError({NASTY!r})"
    nbformat.write(notebook, path)
    commits = {name: github.push(f"transforms-{name}", folder) for name, folder in {"ann": ann, "ben": ben}.items()}

    first = actions()
    assert first.run() == [("find", True), ("transforms-ann", True), ("transforms-ben", True)]
    told = {name: github.runs[f"transforms-{name}"] for name in commits}
    for name, (run,) in told.items():
        assert run["name"] == "points" and run["status"] == "completed" and run["head_sha"] == commits[name]
        assert run["output"]["summary"] in first.summary
        rows = table(run["output"]["summary"])
        assert [row[1] for row in rows] == NAMES and {len(row) for row in rows} == {4}
    (run,) = told["ann"]
    assert run["conclusion"] == "success" and run["output"]["title"] == f"{points():g} of {points():g} points"
    assert {row[3] for row in table(run["output"]["summary"])} == {""}
    (run,) = told["ben"]
    assert run["conclusion"] == "failure"
    assert run["output"]["title"] == f"{points('1_rotation'):g} of {points():g} points"
    words = {row[1]: row[3] for row in table(run["output"]["summary"])}
    assert words["chain"] == "The file could not be read."
    assert words["waypoint"] == "There is no 5_pre_grasp.ipynb to grade."
    assert "&lt;script&gt;alert(1)&lt;/script&gt; `code` | [a](javascript:b) **bold**" in words["invert_transform"]
    assert "3&#95;chaining&#46;ipynb&#58; left out&#59; it is a link&#46;" in run["output"]["summary"]

    assert actions().run() == [("find", True)]  # nothing is new
    shutil.copy(solved["5_pre_grasp"], ben)
    commits["ben"] = github.push("transforms-ben", ben)
    assert actions().run() == [("find", True), ("transforms-ben", True)]
    assert github.runs["transforms-ben"][-1]["head_sha"] == commits["ben"] and len(github.runs["transforms-ben"]) == 2
    earned = points("1_rotation") + points("5_pre_grasp")
    assert github.runs["transforms-ben"][-1]["output"]["title"] == f"{earned:g} of {points():g} points"


def test_a_job_in_which_nothing_could_be_graded_fails_and_tells_nobody(github, actions, work, course_files, sandboxed):
    shutil.rmtree(course_files / "notebooks")
    github.push(COURSE, course_files)
    github.push("transforms-ann", work("ann", {}))
    run = actions()
    assert run.run() == [("find", True), ("transforms-ann", False)]
    assert run.summary == "" and not github.runs


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
