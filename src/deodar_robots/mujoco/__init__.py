"""A world with real physics: scene and robot files, objects, cameras, and the motion of a tool. The world is
`dd.MuJoCo`.
"""
