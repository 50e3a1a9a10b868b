"""Runs drogue-options for tests of its interface."""

import subprocess

import gas_program

PROGRAM = gas_program.BIN / "drogue-options"
BATCHES = gas_program.SOURCE / "miniapps/options/batches"

COLUMNS = ["id", "price", "error", "delta", "gamma", "theta", "exercise_boundary", "mesh", "steps", "status", "message"]
GREEKS = ["vega", "rho"]  # columns behind the others with --greeks
HEADER = "id,style,type,spot,strike,rate,dividend,maturity,lambda,alpha,beta,delta,variance"

# European prices by the Fourier integral take a fraction of a millisecond.
FAST = ("--method", "cos")


def row(identity, **values):
    """A line of a batch with HEADER; what is not given is that of a European put."""
    usual = {"style": "european", "type": "put", "spot": 1.0, "strike": 1.0, "rate": 0.1, "dividend": 0, "maturity": 1,
             "lambda": 1, "alpha": 8.15, "beta": -2.5, "delta": 0.767, "variance": 0.4}
    return ",".join([str(identity), *(str({**usual, **values}[name]) for name in HEADER.split(",")[1:])])


def batch(rows):
    return "\n".join([HEADER, *rows]) + "\n"


class OptionsTest(gas_program.GasTest):
    """A test with an empty folder, in which drogue-options runs."""

    program = PROGRAM

    def write(self, content, name="batch.csv"):
        file = self.folder / name
        file.write_bytes(content if isinstance(content, bytes) else content.encode())
        return file

    def price(self, code, content, *words, **settings):
        """Prices a batch given by its content; returns the output of the run."""
        return self.expect(code, "price", self.write(content), "--backend", "serial", "--quiet", *words, **settings)

    def prices(self, name="prices.csv"):
        header = (self.folder / name).read_text(encoding="utf-8").splitlines()[0].split(",")
        self.assertIn(header, (COLUMNS, COLUMNS + GREEKS))
        return self.table(name)

    def names(self):
        return sorted(path.name for path in self.folder.iterdir())

    def run_with(self, *words, **settings):
        """Runs with settings of subprocess, say a limit."""
        return subprocess.run([PROGRAM, *map(str, words)], cwd=self.folder, capture_output=True, text=True, check=False,
                              timeout=300, env=gas_program.ENVIRONMENT, **settings)
