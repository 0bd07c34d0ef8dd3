class Node:
    def __init__(self, *, package: str, executable: str, output: str, parameters: list) -> None:
        self.package, self.executable, self.parameters = package, executable, parameters
