"""The files of a small campaign without defects, for tests to break one at a time."""

TOML = """title = "a test"
[section]
EA = "4.0e5 N"
GA = "1.6e5 N"
EI = "95 N m^2"
GJ = "60 N m^2"
mass_per_length = "4.6 kg/m"
"""
LIST = """id,kind,file,specimen,repeat_of,set,specimen length [m]
a,bending,a.csv,S1,,calibrate,1
b,bending,b.csv,S1,a,calibrate,1
c,tension,c.csv,S1,,validate,2
"""
LOOP = "time [s],curvature [1/m],moment [N m]\n" + "".join(
    f"{t},{0.1 * (t % 5)},{9.5 * (t % 5) + 0.1}\n" for t in range(12)
)
PULL = "time [s],extension [mm],force [N]\n" + "".join(f"{t},{t},{200 * t}\n" for t in range(12))

FILES = {
    "campaign.toml": TOML,
    "experiments.csv": LIST,
    "a.csv": LOOP,
    "b.csv": LOOP.replace("0.1\n", "0.2\n"),
    "c.csv": PULL,
}
