"""Ways through node trees: past reroutes, muted nodes and groups to the node that really feeds a socket."""
from typing import NamedTuple


class NotExpressible(Exception):
    """A node, or a use of one, that Relief has nothing for."""


class Wire(NamedTuple):
    """A socket, and the group nodes that it is inside of, outermost first."""
    socket: object
    groups: tuple = ()


class Source(NamedTuple):
    """The node and its output that feed a wire; without a node the wire ends at `wire.socket`'s own value."""
    wire: Wire
    node: object = None
    output: object = None

    def input(self, name):
        """The wire of an input, by identifier or name; None if the node has none."""
        for socket in self.node.inputs:
            if socket.identifier == name:
                return Wire(socket, self.wire.groups)
        for socket in self.node.inputs:
            if socket.name == name:
                return Wire(socket, self.wire.groups)
        return None


def find_by_identifier(sockets, identifier):
    return next((socket for socket in sockets if socket.identifier == identifier), None)


def _enter_group(node, output):
    """The socket inside of a group that gives an output of it, or None."""
    if node.node_tree is None:
        return None
    ends = [n for n in node.node_tree.nodes if n.bl_idname == "NodeGroupOutput"]
    end = next((n for n in ends if n.is_active_output), ends[0] if ends else None)
    return find_by_identifier(end.inputs, output.identifier) if end else None


def _pass_muted(node, output):
    return next((link.from_socket for link in node.internal_links if link.to_socket == output), None)


def follow(wire):
    """The source of a wire."""
    socket, groups = wire
    while True:
        link = next((link for link in socket.links if link.is_valid and not link.is_muted), None)
        if link is None:
            return Source(Wire(socket, groups))
        node, output = link.from_node, link.from_socket
        if node.mute:
            socket = _pass_muted(node, output)
        elif node.bl_idname == "NodeReroute":
            socket = node.inputs[0]
        elif node.bl_idname == "ShaderNodeGroup":
            inner, groups = _enter_group(node, output), groups + (node,)
            socket = inner
        elif node.bl_idname == "NodeGroupInput" and groups:
            socket, groups = find_by_identifier(groups[-1].inputs, output.identifier), groups[:-1]
        else:
            return Source(Wire(socket, groups), node, output)
        if socket is None:
            raise NotExpressible(f'node "{node.name}" gives nothing')


def find_output(tree):
    """The active output node for Cycles and others of a node tree, or None."""
    return tree.get_output_node("CYCLES") or tree.get_output_node("ALL")
