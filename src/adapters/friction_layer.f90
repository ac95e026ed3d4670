!> The contact as a thin layer of elements: gap = thickness * strain, traction = stress. What the
!> UMATs of Abaqus and CalculiX share. Nothing here is allocated: components are gathered one by
!> one.
module friction_layer
    use friction_host, only : append, elastic_energy, error_length, error_text, hold_touching, &
        host_update, usable, used_length
    use friction_kinds, only : wp
    use friction_law_constants, only : positive
    use friction_mod, only : friction_bad_increment, friction_bad_property, friction_bad_size, &
        friction_is_orthotropic, friction_ok, prop_alpha_t, statev_dissipation, statev_size, &
        statev_u_et, statev_u_n
    implicit none
    private

    public :: layer_constants, layer_error_text, layer_update, make_symmetric, perturb_layer, &
        read_layer

    !> Places of the layer's own constants; those of the friction routine follow.
    integer, parameter :: prop_thickness = 1, prop_modulus = 2
    integer, parameter, public :: first_friction_prop = 3

    !> A layer's own constants.
    type :: layer_constants
        real(wp) :: thickness   !! > 0 [L]
        real(wp) :: modulus     !! in the plane, >= 0 [F/L^2]
    end type layer_constants

    !> Where the components of the traction stand in the host's stress.
    type :: layer_components
        integer :: n = 0              !! components of the traction, 2 or 3
        integer :: place(3) = 0       !! normal, tangential 1 and 2
        integer :: direct(2) = 0      !! stresses in the layer's plane; 0 for none
        integer :: shear = 0          !! shear stress in the layer's plane; 0 for none
    end type layer_components

contains

    !> The layer's own constants from a host's list of them.
    pure subroutine read_layer(nprops, props, layer, status)
        integer, intent(in) :: nprops
        real(wp), intent(in) :: props(nprops)   !! thickness, modulus, friction constants
        type(layer_constants), intent(out) :: layer
        integer, intent(out) :: status          !! ok, bad size, or bad property

        status = friction_bad_size
        if (nprops < first_friction_prop) return
        status = friction_bad_property
        layer = layer_constants(props(prop_thickness), props(prop_modulus))
        if (.not. (usable(layer%thickness) .and. usable(layer%modulus))) return
        if (layer%thickness < positive .or. layer%modulus < 0.0_wp) return
        if (layer%modulus > 0.0_wp .and. layer%modulus < positive) return
        status = friction_ok
    end subroutine read_layer

    !> As `error_text`, also of the layer's own constants.
    pure function layer_error_text(status, props) result(text)
        integer, intent(in) :: status                  !! of an update
        real(wp), intent(in), contiguous :: props(:)   !! thickness, modulus, friction constants
        character(len=error_length) :: text
        type(layer_constants) :: layer
        integer :: length, found

        text = error_text('UMAT', status, props(first_friction_prop:))
        call read_layer(size(props), props, layer, found)
        if (found /= friction_bad_property) return
        length = used_length(text)
        call append(text, length, ', the thickness of the layer must be > 0 and its modulus >= 0')
    end function layer_error_text

    !> Within the surface, the stiffness of friction that depends on the direction is not symmetric.
    !> For a host that keeps the symmetric part of it.
    !>
    !> Radial sliding turns the traction only by motion across it: in axes along and across, the
    !> stiffness is triangular. Its diagonal has the same eigenvalues, while the symmetric part may
    !> be that of an unstable contact. Of that of other sliding Newton's iterations go round in
    !> circles; with a small share of the elastic stiffness they come to rest.
    pure subroutine make_symmetric(nprops, props, traction, stiffness)
        integer, intent(in) :: nprops
        real(wp), intent(in) :: props(nprops)     !! as in `layer_update`, after which it is called
        real(wp), intent(in) :: traction(2)       !! tangential [F/L^2]
        real(wp), intent(inout) :: stiffness(2, 2)   !! tangential [F/L^2]
        real(wp), parameter :: share = 0.05_wp, round_off = sqrt(epsilon(1.0_wp))
        real(wp) :: axes(2, 2), own(2, 2), length
        integer :: i

        if (.not. friction_is_orthotropic(props(first_friction_prop:))) return
        length = hypot(traction(1), traction(2))
        if (.not. length > 0.0_wp) return
        axes(:, 1) = traction / length
        axes(:, 2) = [-axes(2, 1), axes(1, 1)]
        own = matmul(transpose(axes), matmul(stiffness, axes))
        if (abs(own(2, 1)) <= round_off * sum(abs(own))) then
            own(1, 2) = 0.0_wp
            own(2, 1) = 0.0_wp
            stiffness = matmul(axes, matmul(own, transpose(axes)))
        else
            stiffness = (1.0_wp - share) * stiffness
            do i = 1, 2
                stiffness(i, i) = stiffness(i, i) + share * props(prop_thickness) &
                    * props(first_friction_prop - 1 + prop_alpha_t)
            end do
        end if
    end subroutine make_symmetric

    !> Stress and stiffness of a layer element from a strain increment.
    !>
    !> The layer's normal is axis 3 of a solid, axis 2 in plane strain, the first component of a
    !> cohesive element. In its plane the layer is elastic and does not contract sideways.
    pure subroutine layer_update(ndi, nshr, nprops, props, dstran, dtime, statev, stress, ddsdde, &
        sse, spd, status)
        integer, intent(in) :: ndi, nshr            !! direct and shear components of the host
        integer, intent(in) :: nprops
        real(wp), intent(in) :: props(nprops)   !! thickness [L], modulus [F/L^2], friction's
        real(wp), intent(in) :: dstran(ndi + nshr)   !! strain increment, engineering shear [-]
        real(wp), intent(in) :: dtime               !! [T]
        real(wp), intent(inout) :: statev(statev_size)    !! state of the friction routine
        real(wp), intent(inout) :: stress(ndi + nshr)     !! start in, end out; tension positive
                                                          !! [F/L^2]
        real(wp), intent(inout) :: ddsdde(ndi + nshr, ndi + nshr)   !! d(stress)/d(dstran) [F/L^2]
        real(wp), intent(inout) :: sse, spd   !! energy per volume: elastic, dissipated [F/L^2]
        integer, intent(out) :: status              !! of the friction routine
        type(layer_components) :: at
        type(layer_constants) :: layer
        real(wp) :: du(3), traction(3), tangent(9)
        integer :: i, j

        at = components(ndi, nshr)
        call read_layer(nprops, props, layer, status)
        if (status < 0) return
        status = friction_bad_increment
        if (.not. usable_in_plane(at, ndi + nshr, layer%modulus, dstran, stress)) return
        do i = 1, at%n
            if (.not. usable(dstran(at%place(i)))) return
            du(i) = layer%thickness * dstran(at%place(i))
        end do
        call host_update(at%n, du, dtime, nprops - first_friction_prop + 1, &
            props(first_friction_prop), statev, traction, tangent, status)
        if (status < 0) return
        call hold_touching(at%n, du, 0.0_wp, props(first_friction_prop), statev, tangent)
        call extend_in_plane(at, ndi + nshr, layer%modulus, dstran, stress, ddsdde, sse)
        do j = 1, at%n
            stress(at%place(j)) = traction(j)
            do i = 1, at%n
                ddsdde(at%place(i), at%place(j)) = layer%thickness * tangent((j - 1) * at%n + i)
            end do
        end do
        sse = sse + elastic_energy(props(first_friction_prop), statev(statev_u_n), &
            statev(statev_u_et), statev(statev_u_et + 1)) / layer%thickness
        spd = statev(statev_dissipation) / layer%thickness
    end subroutine layer_update

    !> A linear perturbation step: the stiffness of the base state, which is elastic as nothing
    !> slides without time, and the stress that a strain makes about it. State and stress stay.
    pure subroutine perturb_layer(ndi, nshr, nprops, props, strain, statev, stress, ddsdde, &
        change, status)
        integer, intent(in) :: ndi, nshr            !! as in `layer_update`, and so on
        integer, intent(in) :: nprops
        real(wp), intent(in) :: props(nprops)
        real(wp), intent(in) :: strain(ndi + nshr)  !! from the base state, engineering shear [-]
        real(wp), intent(in) :: statev(statev_size)
        real(wp), intent(in) :: stress(ndi + nshr)  !! of the base state [F/L^2]
        real(wp), intent(inout) :: ddsdde(ndi + nshr, ndi + nshr)
        real(wp), intent(inout) :: change(ndi + nshr)   !! out: of the stress [F/L^2]
        integer, intent(out) :: status
        integer, parameter :: most = 6   ! arrays of another size would be allocated
        real(wp) :: still(most), carried(most), state(statev_size), sse, spd
        integer :: n, j

        n = ndi + nshr
        status = friction_bad_size
        if (n > most) return
        status = friction_bad_increment
        if (.not. all(usable(strain))) return
        still = 0.0_wp
        carried(:n) = stress
        state = statev
        call layer_update(ndi, nshr, nprops, props, still, 0.0_wp, state, carried, ddsdde, sse, &
            spd, status)
        if (status < 0) return
        change = 0.0_wp
        do j = 1, n
            change = change + ddsdde(:, j) * strain(j)
        end do
    end subroutine perturb_layer

    !> Elastic stresses in the plane of the layer; everything else of the stiffness is set to zero.
    pure subroutine extend_in_plane(at, ntens, modulus, dstran, stress, ddsdde, energy)
        type(layer_components), intent(in) :: at
        integer, intent(in) :: ntens
        real(wp), intent(in) :: modulus             !! [F/L^2]
        real(wp), intent(in) :: dstran(ntens)
        real(wp), intent(inout) :: stress(ntens), ddsdde(ntens, ntens)
        real(wp), intent(out) :: energy             !! elastic, per volume [F/L^2]
        integer :: places(3), i, k
        real(wp) :: stiffness(3)

        places = [at%direct, at%shear]
        stiffness = modulus * [1.0_wp, 1.0_wp, 0.5_wp]
        ddsdde = 0.0_wp
        energy = 0.0_wp
        if (.not. modulus > 0.0_wp) return
        do k = 1, size(places)
            i = places(k)
            if (i == 0) cycle
            stress(i) = stress(i) + stiffness(k) * dstran(i)
            ddsdde(i, i) = stiffness(k)
            energy = energy + 0.5_wp * stress(i) * (stress(i) / stiffness(k))
        end do
    end subroutine extend_in_plane

    !> Are strains and stresses in the plane of the layer, which the friction routine does not see,
    !> in the range that it takes?
    pure function usable_in_plane(at, ntens, modulus, dstran, stress) result(usable_)
        type(layer_components), intent(in) :: at
        integer, intent(in) :: ntens
        real(wp), intent(in) :: modulus             !! [F/L^2]
        real(wp), intent(in) :: dstran(ntens)
        real(wp), intent(in) :: stress(ntens)       !! at the start [F/L^2]
        logical :: usable_
        integer :: places(3), i, k

        places = [at%direct, at%shear]
        usable_ = .false.
        do k = 1, size(places)
            i = places(k)
            if (i == 0) cycle
            if (.not. usable(dstran(i))) return
            if (.not. modulus > 0.0_wp) cycle
            if (.not. (usable(stress(i)) .and. usable(modulus * dstran(i)))) return
        end do
        usable_ = .true.
    end function usable_in_plane

    pure function components(ndi, nshr) result(at)
        integer, intent(in) :: ndi, nshr
        type(layer_components) :: at

        if (ndi == 3 .and. nshr == 3) then        ! solid: 11, 22, 33, 12, 13, 23
            at = layer_components(3, [3, 5, 6], [1, 2], 4)
        else if (ndi == 3 .and. nshr == 1) then   ! plane strain: 11, 22, 33, 12
            at = layer_components(2, [2, 4, 0], [1, 3], 0)
        else if (ndi == 1 .and. nshr == 2) then   ! cohesive element in space
            at = layer_components(3, [1, 2, 3], [0, 0], 0)
        else if (ndi == 1 .and. nshr == 1) then   ! cohesive element in the plane
            at = layer_components(2, [1, 2, 0], [0, 0], 0)
        end if
    end function components

end module friction_layer
