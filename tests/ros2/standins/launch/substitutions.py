class LaunchConfiguration:
    def __init__(self, variable_name: str) -> None:
        self.name = variable_name
