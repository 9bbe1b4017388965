"""Numbers of ranks on which the runs of a case of tests/run.py are made, by day and by night."""

import re


def fault_of_ranks(case):
    """What is wrong with the numbers of ranks of a case: a run on none that the case makes, or a comparison that no day or night makes."""
    own = case.get("ranks", [1])
    for name, run in case["run"].items():
        if not set(run.get("ranks", own)) <= set(own):
            return f"run {name} is on ranks that the case is not made on"
    for check in case.get("check", []):
        name = check.get("run", next(iter(case["run"])))
        run = case["run"][name]
        if "across_ranks" in check and len({*run.get("ranks", own), *run.get("night", [])}) < 2:
            return f"across_ranks of {name}, which is made on one number of ranks by day and by night"
        met = [{*case["run"][each].get("ranks", own), *case["run"][each].get("night", [])} for each in runs_of(check, case["run"])]
        if not set.intersection(*met):
            return f"check '{check.get('why', name)}' compares runs that are never made on the same number of ranks"
        if not set(check.get("ranks", set.union(*met))) & set.intersection(*met):
            return f"check '{check.get('why', name)}' is on ranks that its runs are never made on"
    return None


def runs_of(check, runs):
    """Names of the runs that a check looks at."""
    named = {check.get("run"), check.get("equals_run"), *re.findall(r"{(\w+)}", check.get("command", ""))}
    return named & set(runs) or {next(iter(runs))}


def groups_of(case):
    """Names of the runs, those that share results or a check together."""
    runs, group = case["run"], {name: {name} for name in case["run"]}
    together = [{name, *re.findall(r"{(\w+)}", str(run))} & set(runs) for name, run in runs.items()]
    for names in together + [runs_of(check, runs) for check in case.get("check", [])]:
        joined = set().union(*(group[name] for name in names))
        group.update(dict.fromkeys(joined, joined))
    return [names for name, names in group.items() if name == next(each for each in runs if each in names)]


def thin(case):
    """By day, where a run begins much sooner on one rank, that is done on several ranks by one of twelve bad inputs that ask for no
    numbers of ranks, and by one of five groups of runs that no check compares across ranks. Of two ranks and three, three do, of
    which one has neighbours on both sides: in groups whose runs on two ranks are all on three as well."""
    runs, first = case["run"], next(iter(case["run"]))
    across = {check.get("run", first) for check in case.get("check", []) if "across_ranks" in check}
    every = groups_of(case)
    groups = [names for names in every if not names & across]
    bad = [min(names) for names in groups if len(names) == 1 and all("error" in runs[name] for name in names)]
    for k, name in enumerate(name for name in bad if not runs[name]["own"]):
        runs[name]["ranks"] = runs[name]["ranks"] if k % 12 == 0 else [1]
    for k, names in enumerate(names for names in groups if not names <= set(bad)):
        for name in names if k % 5 else ():
            runs[name]["ranks"] = runs[name]["ranks"][:1]
    for names in every:
        if all(3 in runs[name]["ranks"] for name in names if 2 in runs[name]["ranks"]):
            for name in names:
                runs[name]["ranks"] = [ranks for ranks in runs[name]["ranks"] if ranks != 2]


def ranks_of_runs(case, chosen, night):
    """Gives each run its numbers of ranks, by night those of the night too; all of these, in order, with `chosen` first."""
    for run in case["run"].values():
        run["own"] = "ranks" in run
        run["ranks"] = run.get("ranks", chosen) + (run.get("night", []) if night else [])
    if not night:
        thin(case)
    return chosen + sorted({ranks for run in case["run"].values() for ranks in run["ranks"]} - set(chosen))
