"""Median results of reference optimisers on published test functions, 20 seeds, equal budgets.

Functions in dimension 10, optimum moved off the middle of the box: sphere, Rosenbrock (1960), Rastrigin, Ackley (1987); ZDT1 to ZDT3
(Zitzler, Deb and Thiele, 2000) in dimension 30, measured by the hypervolume below (1.1, 1.1). Packages (not in requirements.txt, only
this script needs them): cma 4.5.0, pymoo 0.6.2, pyswarms 1.3.0, with numpy 2.4.6 and scipy 1.17.1. Every library with its own defaults
unless said. `make_optimisers.py NAME ...` makes only the rows of these algorithms and prints them; without a name it writes the file.
"""
import logging
import os
import sys
import tempfile
import warnings

import numpy as np
from fixture import write

warnings.filterwarnings("ignore")
DIMENSION, BUDGET, SEEDS = 10, 10_000, range(1, 21)
SHIFT = np.array([1.2 - 0.3 * (j % 5) for j in range(DIMENSION)])


def sphere(x):
    return float(np.sum((x - SHIFT) ** 2))


def rosenbrock(x):
    return float(np.sum(100.0 * (x[1:] - x[:-1] ** 2) ** 2 + (1.0 - x[:-1]) ** 2))


def rastrigin(x):
    z = x - SHIFT
    return float(np.sum(z**2 - 10.0 * np.cos(2.0 * np.pi * z) + 10.0))


def ackley(x):
    z = x - SHIFT
    return float(-20.0 * np.exp(-0.2 * np.sqrt(np.mean(z**2))) - np.exp(np.mean(np.cos(2.0 * np.pi * z))) + 20.0 + np.e)


FUNCTIONS = {"sphere": (sphere, 5.12), "rosenbrock": (rosenbrock, 5.12), "rastrigin": (rastrigin, 5.12), "ackley": (ackley, 32.768)}


class Counted:
    """Cost of a point, with the best of the first BUDGET evaluations."""

    def __init__(self, function):
        self.function, self.left, self.best = function, BUDGET, np.inf

    def __call__(self, x):
        value = self.function(np.asarray(x))
        if self.left > 0:
            self.left -= 1
            self.best = min(self.best, value)
        return value


def start(seed, bound):
    return np.random.default_rng(seed).uniform(-bound, bound, DIMENSION)


def cma_es(cost, bound, seed):
    import cma

    options = {"bounds": [-bound, bound], "maxfevals": BUDGET, "seed": seed, "verbose": -9}
    # A new random start for each restart, and a first step of 0.3 of the box.
    begin = np.random.default_rng(seed)
    cma.fmin2(cost, lambda: begin.uniform(-bound, bound, DIMENSION), 0.6 * bound, options, restarts=9, incpopsize=2)


def scipy_de(strategy):
    def run(cost, bound, seed):
        from scipy.optimize import differential_evolution

        differential_evolution(cost, [(-bound, bound)] * DIMENSION, strategy=strategy, polish=False, tol=0.0, atol=0.0,
                               maxiter=BUDGET // (15 * DIMENSION), rng=seed)

    return run


def nelder_mead(cost, bound, seed):
    from scipy.optimize import minimize

    # With as many new random starts as the budget allows.
    begin = np.random.default_rng(seed)
    while cost.left > 0:
        minimize(cost, begin.uniform(-bound, bound, DIMENSION), method="Nelder-Mead", bounds=[(-bound, bound)] * DIMENSION,
                 options={"maxfev": cost.left, "adaptive": True})


def pyswarms_pso(cost, bound, seed):
    # It writes a log where it stands.
    os.chdir(tempfile.gettempdir())
    import pyswarms

    logging.disable(logging.CRITICAL)
    np.random.seed(seed)
    # It has no defaults: Clerc and Kennedy's (2002) numbers and 40 particles.
    swarm = pyswarms.single.GlobalBestPSO(40, DIMENSION, {"c1": 1.49618, "c2": 1.49618, "w": 0.7298},
                                          bounds=(np.full(DIMENSION, -bound), np.full(DIMENSION, bound)))
    swarm.optimize(lambda points: np.array([cost(x) for x in points]), BUDGET // 40, verbose=False)


def pymoo_run(name):
    def run(cost, bound, seed):
        from pymoo.algorithms.soo.nonconvex.de import DE
        from pymoo.algorithms.soo.nonconvex.ga import GA
        from pymoo.algorithms.soo.nonconvex.pso import PSO
        from pymoo.core.problem import ElementwiseProblem
        from pymoo.optimize import minimize

        class Problem(ElementwiseProblem):
            def __init__(self):
                super().__init__(n_var=DIMENSION, n_obj=1, xl=-bound, xu=bound)

            def _evaluate(self, x, out, *args, **kwargs):
                out["F"] = cost(x)

        minimize(Problem(), {"pso": PSO, "ga": GA, "de": DE}[name](), ("n_eval", BUDGET), seed=seed)

    return run


SINGLE = {
    ("cma-es", "cma"): cma_es,
    ("de", "scipy-rand1bin"): scipy_de("rand1bin"),
    ("de", "scipy-best1bin"): scipy_de("best1bin"),
    ("de", "pymoo"): pymoo_run("de"),
    ("pso", "pymoo"): pymoo_run("pso"),
    ("pso", "pyswarms"): pyswarms_pso,
    ("ga", "pymoo"): pymoo_run("ga"),
    ("nelder-mead", "scipy"): nelder_mead,
}


def single(algorithm, library):
    for name, (function, bound) in FUNCTIONS.items():
        results = []
        for seed in SEEDS:
            cost = Counted(function)
            SINGLE[algorithm, library](cost, bound, seed)
            results.append(cost.best)
        yield summary(algorithm, library, name, results)


def several(name):
    from pymoo.algorithms.moo.nsga2 import NSGA2
    from pymoo.indicators.hv import HV
    from pymoo.optimize import minimize
    from pymoo.problems import get_problem

    measure = HV(ref_point=np.array([1.1, 1.1]))
    results = [float(measure(minimize(get_problem(name), NSGA2(pop_size=100), ("n_eval", BUDGET), seed=seed).F)) for seed in SEEDS]
    return summary("nsga-ii", "pymoo", name, results)


def summary(algorithm, library, function, results):
    row = [algorithm, library, function, BUDGET, len(results), *np.quantile(results, [0.25, 0.5, 0.75]).tolist()]
    print(*row, flush=True)
    return row


def rows(wanted):
    for algorithm, library in SINGLE:
        if not wanted or f"{algorithm}/{library}" in wanted:
            yield from single(algorithm, library)
    if not wanted or "nsga-ii/pymoo" in wanted:
        for name in ("zdt1", "zdt2", "zdt3"):
            yield several(name)


if __name__ == "__main__":
    made = list(rows(sys.argv[1:]))
    if not sys.argv[1:]:
        write("fspid-optimise", "optimisers.csv", "optimiser,library,function,budget,seeds,lower_quartile,median,upper_quartile", made)
