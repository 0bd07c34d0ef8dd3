class LaunchDescription:
    def __init__(self, entities: list) -> None:
        self.entities = entities
